//! Time series, and pictures of them.

use std::fs;

use approx::assert_relative_eq;

use crate::{BOX, FLUID, Folder, rows};

/// A column of the series; `None` for empty fields.
fn column(folder: &Folder, name: &str) -> Vec<Option<f64>> {
    let (names, rows) = rows(&folder.path("series.csv"));
    let column = names.iter().position(|other| other == name).unwrap();
    rows.iter().map(|row| row[column].parse().ok()).collect()
}

#[test]
fn the_series_of_a_fluid_adds_up_to_its_summary() {
    for engine in ["stepped", "event-driven"] {
        let folder = Folder::with(FLUID);
        let run = format!("run scene.toml --json --engine {engine}");
        let plain = folder.says(&run).summary();
        let with = folder.says(&format!("{run} --series series.csv --series-every 0.125"));
        let with = with.summary();
        assert_eq!(with["state_hash"], plain["state_hash"]);
        assert_eq!(with["compressibility"], plain["compressibility"]);
        let times: Vec<f64> = column(&folder, "time").into_iter().flatten().collect();
        assert_eq!(times.len(), 9);
        for (k, time) in times.iter().enumerate() {
            // A step at or next behind each time.
            let late = time - 0.125 * k as f64;
            assert!((0.0..0.002).contains(&late) && (late == 0.0 || engine == "stepped"));
        }
        let last = |name: &str| column(&folder, name).last().unwrap().unwrap();
        assert_eq!(last("energy"), with["energy"]["final"].as_f64().unwrap());
        assert_eq!(last("pairs"), with["collisions"]["pairs"].as_f64().unwrap());
        assert_eq!(last("surroundings"), 0.0);
        assert_eq!(last("temperature"), with["temperature"]["translational"].as_f64().unwrap());
        // Equal times, one temperature: the mean of the parts is the whole.
        if engine == "event-driven" {
            let factors = column(&folder, "compressibility");
            assert_eq!(factors[0], None);
            let mean = factors.iter().flatten().sum::<f64>() / 8.0;
            let whole = with["compressibility"].as_f64().unwrap();
            assert_relative_eq!(mean, whole, max_relative = 1e-9);
            let rates = column(&folder, "collision_rate").into_iter().flatten().sum::<f64>() / 8.0;
            let whole = with["collision_rate"].as_f64().unwrap();
            assert_relative_eq!(rates, whole, max_relative = 1e-12);
            // p = Z n kT
            let pressure = last("pressure");
            let factor = factors[8].unwrap() * 0.5 * last("temperature");
            assert_relative_eq!(pressure, factor, max_relative = 1e-9);
        }
        // Nothing pulls the bodies: their centre moves with their momentum, of zero.
        for name in ["center_x", "center_y", "center_z"] {
            let places: Vec<f64> = column(&folder, name).into_iter().flatten().collect();
            assert!(places.iter().all(|place| (place - places[0]).abs() < 1e-9), "{places:?}");
        }
    }
}

#[test]
fn the_walls_force_is_what_changes_the_momentum() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --engine event-driven --series series.csv --series-every 0.25";
    folder.says(run).well();
    let all = |name: &str| column(&folder, name);
    let (momentum, force) = (all("pz"), all("force_z"));
    for k in 1..momentum.len() {
        let change = momentum[k].unwrap() - momentum[k - 1].unwrap();
        // Twenty masses, one of them 3, in a field of −1.
        let expected = 0.25 * (force[k].unwrap() - 22.0);
        assert!((change - expected).abs() < 1e-9, "{change} {expected}");
    }
    assert!(all("pressure").iter().all(Option::is_none));
    assert!(all("surroundings_rate")[1..].iter().all(Option::is_some));
}

#[test]
fn parts_with_names_have_columns_and_lines_of_their_own() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --engine event-driven --set surroundings[0].name=wall \
               --set surface.kind=smooth";
    let series = "--series series.csv --series-every 0.25";
    let summary = folder.says(&format!("{run} --json {series}")).summary();
    let all = |name: &str| column(&folder, name);
    // It is all there is.
    for axis in ["x", "y", "z"] {
        assert_eq!(all(&format!("wall.force_{axis}")), all(&format!("force_{axis}")));
    }
    assert_eq!(all("wall.force_x")[0], None);
    assert_eq!(all("wall.collisions"), all("surroundings"));
    let [part] = &summary["parts"].as_array().unwrap()[..] else { panic!("{summary}") };
    assert_eq!((&part["index"], &part["name"]), (&0.into(), &"wall".into()));
    assert_eq!(part["collisions"], summary["collisions"]["surroundings"]);
    assert_eq!(part["impulse"], summary["momentum"]["from_surroundings"]);
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let last = all(&format!("wall.impulse_{axis}")).pop().unwrap();
        assert_eq!(last, part["impulse"][k].as_f64());
    }
    // On six walls of 16: magnitudes add up to no less than vectors do.
    let (pressures, forces) = (all("wall.pressure"), all("wall.force_z"));
    assert_eq!(pressures[0], None);
    for (pressure, force) in pressures.iter().zip(&forces).skip(1) {
        assert!(pressure.unwrap() * 96.0 >= force.unwrap().abs(), "{pressure:?} {force:?}");
    }
    let printed = folder.says(run).well();
    assert!(printed.contains("parts") && printed.contains("  wall"), "{printed}");
    // After a time without measurement.
    let later = folder.says(&format!("{run} --json --set equilibrate=0.5")).summary();
    assert_eq!(later["parts"][0]["collisions"], later["collisions"]["surroundings"]);
    // Without a name a part has no column, and a single one no line.
    let plain = "run scene.toml --engine event-driven";
    assert!(!folder.says(plain).well().contains("parts"));
    folder.says(&format!("{plain} {series}")).well();
    assert!(!folder.read("series.csv").contains(".force_x"));
}

#[test]
fn columns_are_chosen_by_name() {
    let with = |keys: &str| Folder::with(&format!("{FLUID}\n[series]\n{keys}\n"));
    let folder =
        with("file = \"series.csv\"\nevery = 0.5\ncolumns = [\"pressure\", \"time\", \"px\"]");
    folder.says("run scene.toml").well();
    let text = folder.read("series.csv");
    assert_eq!(text.lines().next(), Some("pressure,time,px"));
    assert_eq!(text.lines().count(), 4);
    for (keys, words) in [
        (
            "file = \"a.csv\"\nevery = 1\ncolumns = [\"presure\"]",
            "scene.toml:18: series.columns is",
        ),
        ("file = \"a.txt\"\nevery = 1", "scene.toml:16: series.file is"),
        ("file = \"a.csv\"", "--series-every TIME"),
        ("file = \"a.csv\"\nevery = -1", "scene.toml:17: series.every is -1.0"),
    ] {
        let folder = with(keys);
        let message = folder.says("run scene.toml").fails_with(2);
        assert!(message.contains(words), "no {words:?} in: {message}");
        assert_eq!(folder.names(), ["scene.toml"]);
    }
}

#[test]
fn a_series_is_drawn() {
    let folder = Folder::with(FLUID);
    folder.says("run scene.toml --series gas.csv --series-every 0.1").well();
    folder.says("plot gas.csv").well();
    let picture = folder.read("gas.svg");
    for text in ["<svg", "translational", "pressure", "centre of mass", "collision_rate"] {
        assert!(picture.contains(text), "{text}");
    }
    folder.says("plot gas.csv -o one.svg --columns energy").well();
    let one = folder.read("one.svg");
    assert!(one.contains("energy") && !one.contains("pressure") && one.len() < picture.len());

    let refused = |arguments: &str, words: &[&str]| {
        let message = folder.says(arguments).fails_with(2);
        for word in words {
            assert!(message.contains(word), "no {word:?} in: {message}");
        }
    };
    refused("plot no.csv", &["no.csv"]);
    refused("plot gas.csv -o gas.jpg", &["-o is gas.jpg", ".svg, .png or .pdf"]);
    refused("plot gas.csv --columns enrgy", &["\"enrgy\"", "it has time, energy"]);
    fs::write(folder.path("words.csv"), "a,b\nx,y\n").unwrap();
    refused("plot words.csv", &["words.csv: it must have names"]);
    assert!(!folder.names().contains(&"words.svg".to_owned()));
}

/// A box of balls, and a sensor in its middle.
const SENSED: &str = r#"
duration = 2.0
stepped = { dt = 0.01 }
surroundings = [
  { shape = "box", lower = [-2, -2, -2], upper = [2, 2, 2], inside = true },
  { shape = "disc", name = "hole", center = [0, 0, 0], axis = [0, 0, 1], radius = 1, sensor = true },
  { shape = "plane", point = [0, 0, 0], normal = [0, 0, 1], sensor = true },
]
[[spheres]]
count = 40
arrangement = "random"
radius = 0.1
temperature = 4.0
"#;

#[test]
fn sensors_are_in_the_summary_and_in_the_series() {
    for engine in ["stepped", "event-driven"] {
        let folder = Folder::with(SENSED);
        let run = format!("run scene.toml --engine {engine}");
        let series = "--series series.csv --series-every 0.25";
        let summary = folder.says(&format!("{run} --json {series}")).summary();
        let passages = &summary["parts"][1]["passages"];
        let [inward, outward] = ["inward", "outward"].map(|way| passages[way].as_f64().unwrap());
        assert!(inward > 0.0 && outward > 0.0, "{passages}");
        assert!(summary["parts"][2]["passages"]["inward"].as_f64().unwrap() > inward);
        assert_eq!(summary["parts"][0]["passages"], serde_json::Value::Null);
        let last = |name: &str| column(&folder, name).last().unwrap().unwrap();
        assert_eq!([last("hole.inward"), last("hole.outward")], [inward, outward]);
        let flow: f64 = column(&folder, "hole.flow").into_iter().flatten().sum();
        assert!((flow * 0.25 - (inward - outward)).abs() < 1e-9, "{flow}");
        let (names, _) = rows(&folder.path("series.csv"));
        assert!(!names.iter().any(|name| name == "hole.pressure"));
        let words = folder.says(&run).well();
        assert!(words.contains("sensors") && words.contains("  hole"), "{words}");
        // Kept on the way, as in one run.
        let whole = folder.read("series.csv");
        folder.says(&format!("{run} --duration 1.0 --snapshot run.snapshot {series}"));
        let resumed = format!("run --resume run.snapshot --duration 2.0 --json {series}");
        let resumed = folder.says(&resumed).summary();
        assert_eq!(resumed["parts"], summary["parts"]);
        assert_eq!(folder.read("series.csv"), whole);
    }
}
