//! Draw: a key of a scene file, and how it is varied from scene to scene: by values in
//! turn, or by random numbers of each scene's own.

use carom::scene::Random;

use crate::cli::failure::Failure;
use crate::cli::variation::{Variation, choices};

/// Where the values of a key come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// Between two bounds.
    Uniform(f64, f64),
    /// By its mean and standard deviation.
    Normal(f64, f64),
}

/// A key whose values are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    key: String,
    distribution: Distribution,
}

impl Draw {
    /// Reads `KEY=uniform(a,b)` or `KEY=normal(mean,sd)`; `None` if it is neither.
    fn parse(text: &str) -> Option<Result<Self, Failure>> {
        let (key, values) = text.split_once('=')?;
        let (name, numbers) = values.trim().strip_suffix(')')?.split_once('(')?;
        let refused = |reason: &str| Failure::Argument(format!("--vary {text:?}: {reason}"));
        let numbers: Vec<Option<f64>> =
            numbers.split(',').map(|number| number.trim().parse().ok()).collect();
        let distribution = match (name.trim(), &numbers[..]) {
            ("uniform", &[Some(a), Some(b)]) if a < b && (b - a).is_finite() => {
                Distribution::Uniform(a, b)
            }
            ("normal", &[Some(mean), Some(sd)])
                if mean.is_finite() && sd > 0.0 && sd.is_finite() =>
            {
                Distribution::Normal(mean, sd)
            }
            ("uniform", _) => {
                return Some(Err(refused("it must be uniform(a,b) with finite numbers a < b")));
            }
            ("normal", _) => {
                let wanted = "it must be normal(mean,sd) with finite numbers, sd greater than 0";
                return Some(Err(refused(wanted)));
            }
            _ => return None,
        };
        Some(Ok(Self { key: key.trim().to_owned(), distribution }))
    }

    /// The value for a scene, by its seed; `number` tells its keys apart.
    fn value(&self, seed: u64, number: usize) -> String {
        let mut random = Random::of_seed(seed, number as u64);
        let value = match self.distribution {
            Distribution::Uniform(a, b) => random.between(a, b),
            Distribution::Normal(mean, sd) => mean + sd * random.normal(),
        };
        format!("{value:?}")
    }
}

/// What is varied in a batch, in the order that it is asked for.
#[derive(Clone, Debug)]
pub struct Varied {
    keys: Vec<String>,
    listed: Vec<Variation>,
    drawn: Vec<Draw>,
}

impl Varied {
    /// Reads the values of `--vary`. No key comes twice.
    pub fn parse(texts: &[String]) -> Result<Self, Failure> {
        let mut varied = Self { keys: Vec::new(), listed: Vec::new(), drawn: Vec::new() };
        for text in texts {
            let key = match Draw::parse(text) {
                Some(draw) => {
                    varied.drawn.push(draw?);
                    varied.drawn.last().map(|draw| draw.key.clone())
                }
                None => {
                    varied.listed.push(Variation::parse(text)?);
                    varied.listed.last().map(|variation| variation.key.clone())
                }
            };
            let key = key.unwrap_or_default();
            if varied.keys.contains(&key) {
                return Err(Failure::Argument(format!(
                    "--vary {key} is there twice; give all its values at once, as {key}=a,b,c"
                )));
            }
            varied.keys.push(key);
        }
        Ok(varied)
    }

    /// The keys, in their order.
    pub fn keys(&self) -> Vec<&str> {
        self.keys.iter().map(String::as_str).collect()
    }

    /// The values of a scene with a number and a seed, in the order of the keys: of listed
    /// ones each choice in turn, the first key changing least often.
    pub fn values(&self, scene: u64, seed: u64) -> Vec<String> {
        let choices = choices(&self.listed);
        let choice = &choices[(scene % choices.len() as u64) as usize];
        let of = |key: &String| {
            let listed = self.listed.iter().position(|variation| variation.key == *key);
            let drawn = || self.drawn.iter().enumerate().find(|(_, draw)| draw.key == *key);
            match listed {
                Some(listed) => choice[listed].to_owned(),
                None => drawn().map_or_else(String::new, |(k, draw)| draw.value(seed, k)),
            }
        };
        self.keys.iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn varied(texts: &[&str]) -> Result<Varied, Failure> {
        Varied::parse(&texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn lists_go_in_turn_and_draws_by_the_seed() {
        let all = varied(&["a=1,2", "b=uniform(0,1)", "c=x,y", "d = normal(5, 0.5)"]).unwrap();
        assert_eq!(all.keys(), ["a", "b", "c", "d"]);
        let row = |scene| all.values(scene, 100 + scene);
        let listed: Vec<_> = (0..5).map(|k| [row(k)[0].clone(), row(k)[2].clone()]).collect();
        assert_eq!(listed, [["1", "x"], ["1", "y"], ["2", "x"], ["2", "y"], ["1", "x"]]);
        assert_eq!(row(3), row(3));
        let means = [1, 3].map(|at| {
            let values = (0..4_000).map(|k| row(k)[at].parse::<f64>().unwrap());
            values.sum::<f64>() / 4_000.0
        });
        assert!((means[0] - 0.5).abs() < 0.03 && (means[1] - 5.0).abs() < 0.05, "{means:?}");
        assert!((0..100).all(|k| (0.0..1.0).contains(&row(k)[1].parse::<f64>().unwrap())));
    }

    #[test]
    fn what_means_nothing_is_refused() {
        for (texts, words) in [
            (&["a=uniform(1,0)"][..], "a < b"),
            (&["a=uniform(1)"], "a < b"),
            (&["a=normal(0,-1)"], "sd greater than 0"),
            (&["a=normal(x,1)"], "sd greater than 0"),
            (&["a=1,2", "a=uniform(0,1)"], "twice"),
            (&["a"], "KEY=a,b,c"),
        ] {
            let error = varied(texts).unwrap_err().to_string();
            assert!(error.contains(words), "{texts:?}: {error}");
        }
    }
}
