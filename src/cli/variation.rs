//! Variation: a key of a scene file and the values that it is given, one after the other.

use std::collections::HashSet;

use carom::scene::{SceneError, SceneFile};

use super::arguments::SceneArguments;
use super::failure::Failure;
use super::scene_argument::with_options;

/// More runs than this are a slip of the pen.
pub const MOST_RUNS: u64 = 1_000_000;

/// A key, and its values as a scene file would have them.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    pub key: String,
    pub values: Vec<String>,
}

/// Says what a scene asks for that many runs side by side do not write.
pub fn tell_passed_over(file: &SceneFile, by: &str, written: &[&str]) {
    let mut asked = file.asked_outputs();
    asked.retain(|table| !written.contains(table));
    let are = if asked.len() > 1 { "are" } else { "is" };
    if let Some(last) = asked.pop() {
        let before = if asked.is_empty() { String::new() } else { asked.join(", ") + " and " };
        eprintln!("{before}{last} of the scene {are} passed over: {by} writes a row for each run");
    }
}

impl Variation {
    /// Reads `KEY=a,b,c` or `KEY=from:to:n`.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let refused = |reason: &str| Failure::Argument(format!("--vary {text:?}: {reason}"));
        let wanted = "it must be KEY=a,b,c or KEY=from:to:n, as in spheres[0].radius=0.1,0.2 or \
                      stepped.dt=0.001:0.01:4";
        let (key, values) = text.split_once('=').ok_or_else(|| refused(wanted))?;
        let (key, values) = (key.trim(), values.trim());
        let values = match range(values) {
            Some(values) => values.map_err(|reason| refused(&reason))?,
            None => split(values),
        };
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err(refused(wanted));
        }
        let mut seen = HashSet::new();
        if let Some(twice) = values.iter().find(|value| !seen.insert(*value)) {
            return Err(refused(&format!("the value {twice} is there twice")));
        }
        Ok(Self { key: key.to_owned(), values })
    }

    /// All of them, of which no key comes twice.
    pub fn all(texts: &[String]) -> Result<Vec<Self>, Failure> {
        let all: Vec<Self> =
            texts.iter().map(|text| Self::parse(text)).collect::<Result<_, _>>()?;
        let mut seen = HashSet::new();
        match all.iter().find(|variation| !seen.insert(&variation.key)) {
            None => Ok(all),
            Some(Self { key, .. }) => Err(Failure::Argument(format!(
                "--vary {key} is there twice; give all its values at once, as {key}=a,b,c"
            ))),
        }
    }
}

/// Each value of each key with each of the others, the first key changing least often.
pub fn choices(variations: &[Variation]) -> Vec<Vec<&str>> {
    let mut choices = vec![Vec::new()];
    for Variation { values, .. } in variations {
        choices = choices
            .iter()
            .flat_map(|choice: &Vec<&str>| {
                values.iter().map(|value| {
                    let mut longer = choice.clone();
                    longer.push(value.as_str());
                    longer
                })
            })
            .collect();
    }
    choices
}

/// How many runs that makes, each choice with a number of seeds.
pub fn count(variations: &[Variation], seeds: u64) -> Result<u64, Failure> {
    let counts = variations.iter().map(|variation| variation.values.len() as u64);
    let runs = counts.fold(seeds, u64::saturating_mul);
    if runs <= MOST_RUNS {
        return Ok(runs);
    }
    let most = format!("{runs} runs are too many: {MOST_RUNS} is the most of a sweep");
    Err(Failure::Argument(most))
}

/// The values of `from:to:n`, if that is what a text is.
fn range(text: &str) -> Option<Result<Vec<String>, String>> {
    let [from, to, count]: [&str; 3] =
        text.split(':').map(str::trim).collect::<Vec<_>>().try_into().ok()?;
    let [first, last] = [from, to].map(|text| text.parse::<f64>().ok());
    let (first, last) = (first?, last?);
    let count = match count.parse::<u64>() {
        Ok(count) if (2..=MOST_RUNS).contains(&count) => count,
        _ => {
            let reason = format!("n of from:to:n must be a whole number from 2 to {MOST_RUNS}");
            return Some(Err(reason));
        }
    };
    if !(first.is_finite() && last.is_finite()) || first == last {
        return Some(Err("from:to:n needs two different finite numbers".to_owned()));
    }
    let are_whole = [from, to].iter().all(|text| text.parse::<i64>().is_ok());
    let steps = (count - 1) as f64;
    let value = |k: u64| match k {
        0 => from.to_owned(),
        k if k == count - 1 => to.to_owned(),
        k => shown(first * ((steps - k as f64) / steps) + last * (k as f64 / steps), are_whole),
    };
    Some(Ok((0..count).map(value).collect()))
}

/// A number in the fifteen digits that rounding leaves; a whole one between whole ones
/// without a point.
fn shown(value: f64, are_whole: bool) -> String {
    let value: f64 = format!("{value:.14e}").parse().unwrap_or(value);
    if are_whole && value.fract() == 0.0 { format!("{value}") } else { format!("{value:?}") }
}

/// The pieces between commas that stand in no brackets and no quotes.
pub fn split(text: &str) -> Vec<String> {
    let (mut pieces, mut depth, mut quote) = (vec![String::new()], 0_usize, None);
    for c in text.chars() {
        match (c, quote) {
            (',', None) if depth == 0 => {
                pieces.push(String::new());
                continue;
            }
            ('"' | '\'', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth = depth.saturating_sub(1),
            _ => {}
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(c);
        }
    }
    pieces.iter().map(|piece| piece.trim().to_owned()).collect()
}

/// The scene with one choice of values.
pub fn varied(
    base: &SceneFile,
    arguments: &SceneArguments,
    keys: &[&str],
    choice: &[impl AsRef<str>],
) -> Result<SceneFile, Failure> {
    let values: Vec<String> =
        keys.iter().zip(choice).map(|(key, value)| format!("{key}={}", value.as_ref())).collect();
    let file = base.with_values(&values).map_err(|error| blamed(&error, keys))?;
    Ok(with_options(file, arguments))
}

/// An error of a value that is varied names the option that gives it.
pub fn blamed(error: &SceneError, keys: &[&str]) -> Failure {
    let text = error.to_string();
    let is_varied = |key: &&str| {
        let option = format!("--set {key}");
        text.strip_prefix(&option).is_some_and(|rest| !rest.starts_with(['.', '[']))
    };
    match text.strip_prefix("--set ") {
        Some(rest) if keys.iter().any(is_varied) => Failure::Argument(format!("--vary {rest}")),
        _ => Failure::Argument(text),
    }
}

/// The seeds of a scene's runs, as many as an option says.
pub fn seeds(file: &SceneFile, option: &str, count: u64) -> Result<Vec<u64>, Failure> {
    let last = file.seed.checked_add(count - 1).ok_or_else(|| {
        let seed = file.seed;
        Failure::Argument(format!("{option} {count}: from {seed} on there are not so many seeds"))
    })?;
    Ok((file.seed..=last).collect())
}

/// A key that an option gives one value cannot be given others.
pub fn refuse_both(arguments: &SceneArguments, keys: &[&str]) -> Result<(), Failure> {
    let given = [
        ("precision", "--precision", arguments.precision.is_some()),
        ("engine", "--engine", arguments.engine.is_some()),
        ("stepped.dt", "--dt", arguments.dt.is_some()),
        ("duration", "--duration", arguments.duration.is_some()),
        ("seed", "--seed", arguments.seed.is_some()),
    ];
    match given.into_iter().find(|(key, _, is_given)| *is_given && keys.contains(key)) {
        None => Ok(()),
        Some((key, option, _)) => Err(Failure::Argument(format!(
            "--vary {key} and {option} both give it values; leave out one of them"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Variation::parse(text).unwrap().values
    }

    #[test]
    fn lists_and_ranges_are_read() {
        assert_eq!(values("a=1,2e-3, rough"), ["1", "2e-3", "rough"]);
        assert_eq!(values("gravity=[0,0,-1],[0,0,-2]"), ["[0,0,-1]", "[0,0,-2]"]);
        assert_eq!(values("a={ x = 1, y = 2 },'b,c'"), ["{ x = 1, y = 2 }", "'b,c'"]);
        assert_eq!(values("a=0.1:0.5:5"), ["0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(values("a=100:400:4"), ["100", "200", "300", "400"]);
        assert_eq!(values("a=0:1:3"), ["0", "0.5", "1"]);
        assert_eq!(values("a=1:-1:3"), ["1", "0", "-1"]);
        assert_eq!(values("a=x:y:z"), ["x:y:z"]);
    }

    #[test]
    fn what_means_nothing_is_refused() {
        for (text, words) in [
            ("radius", "KEY=a,b,c"),
            ("=1,2", "KEY=a,b,c"),
            ("a=", "KEY=a,b,c"),
            ("a=1,,2", "KEY=a,b,c"),
            ("a=1,2,1", "the value 1 is there twice"),
            ("a=0:1:1", "from 2 to"),
            ("a=0:1:2.5", "from 2 to"),
            ("a=1:1:3", "two different"),
            ("a=0:inf:3", "two different"),
        ] {
            let error = Variation::parse(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
        let twice = ["a=1".to_owned(), "a=2".to_owned()];
        assert!(Variation::all(&twice).unwrap_err().to_string().contains("twice"));
        let many = Variation { key: "a".to_owned(), values: vec![String::new(); 2000] };
        assert!(count(&[many.clone(), many], 1).is_err());
    }

    #[test]
    fn each_goes_with_each() {
        let all = Variation::all(&["a=1,2".to_owned(), "b=x,y".to_owned()]).unwrap();
        let pairs = [["1", "x"], ["1", "y"], ["2", "x"], ["2", "y"]];
        assert_eq!(choices(&all), pairs);
        assert_eq!(count(&all, 3).unwrap(), 12);
        assert_eq!(choices(&[]), [[""; 0]]);
    }
}
