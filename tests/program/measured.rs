//! What is measured of a gas: after equilibration, with errors.

use approx::assert_relative_eq;

use crate::{BOX, FLUID, Folder, rows};

#[test]
fn equilibration_changes_the_counters_and_no_bit_of_the_run() {
    for (scene, engine) in [(FLUID, "event-driven"), (FLUID, "stepped"), (BOX, "event-driven")] {
        let folder = Folder::with(scene);
        let run = format!("run scene.toml --json --duration 1 --engine {engine}");
        let series = "--series series.csv --series-every 0.25";
        let whole = folder.says(&format!("{run} {series}")).summary();
        let (names, before) = rows(&folder.path("series.csv"));
        let later = folder.says(&format!("{run} {series} --set equilibrate=0.5")).summary();
        let (_, after) = rows(&folder.path("series.csv"));
        assert_eq!(later["equilibrate"], 0.5);
        assert_eq!(whole.get("equilibrate"), None);
        for key in ["state_hash", "energy", "momentum", "time", "steps"] {
            assert_eq!(later[key], whole[key], "{key}");
        }
        // Rows from then on, the first without rates.
        assert_eq!(after.len(), 3);
        assert_eq!(after[2], before[4]);
        let column = |name: &str| names.iter().position(|other| other == name).unwrap();
        let count = |row: &[String], name: &str| row[column(name)].parse::<f64>().unwrap();
        for name in ["pairs", "surroundings"] {
            let measured = count(&before[4], name) - count(&before[2], name);
            assert_eq!(later["collisions"][name].as_f64().unwrap(), measured);
        }
        if engine == "event-driven" && scene == FLUID {
            let rates = [3, 4].map(|row: usize| count(&before[row], "collision_rate"));
            let rate = later["collision_rate"].as_f64().unwrap();
            assert_relative_eq!(rate, 0.5 * (rates[0] + rates[1]), max_relative = 1e-12);
            let factors = [3, 4].map(|row: usize| count(&before[row], "compressibility"));
            let factor = later["compressibility"].as_f64().unwrap();
            assert_relative_eq!(factor, 0.5 * (factors[0] + factors[1]), max_relative = 1e-9);
        }
    }
}

#[test]
fn averages_have_errors_and_the_summary_says_so() {
    let folder = Folder::with(FLUID);
    let run = "run scene.toml --engine event-driven --duration 20 --set equilibrate=2";
    let summary = folder.says(&format!("{run} --json")).summary();
    let statistics = &summary["statistics"];
    for name in ["compressibility", "collision_rate", "mean_free_path"] {
        assert_eq!(statistics[name]["mean"], summary[name], "{name}");
    }
    let names: Vec<&String> = statistics.as_object().unwrap().keys().collect();
    assert_eq!(names, ["collision_rate", "compressibility", "mean_free_path", "pressure"]);
    for (name, figure) in statistics.as_object().unwrap() {
        let (mean, error) = (figure["mean"].as_f64().unwrap(), figure["error"].as_f64().unwrap());
        assert!(error > 0.0 && error < 0.02 * mean, "{name}: {mean} {error}");
        assert_eq!(figure["drifts"], false, "{name}");
    }
    // Of 256 spheres at density ½ (3.2694 for many), by its own error.
    let figure = &statistics["compressibility"];
    let off = figure["mean"].as_f64().unwrap() - 3.2694;
    assert!(off.abs() < 0.01 + 3.0 * figure["error"].as_f64().unwrap(), "{figure}");
    let text = folder.says(run).well();
    assert!(text.contains(" ± ") && text.contains("measured after 2"), "{text}");

    let rough = folder.says(&format!("{run} --json --set surface.kind=rough")).summary();
    let statistics = rough["statistics"].as_object().unwrap();
    assert!(statistics.contains_key("temperature") && statistics.contains_key("spin_temperature"));
    // A few steps have no blocks of equal length.
    let short = folder.says("run scene.toml --json --duration 0.02").summary();
    assert_eq!(short.get("statistics"), None);
}

#[test]
fn a_periodic_box_is_in_the_summary() {
    let folder = Folder::with(FLUID);
    let summary = folder.says("run scene.toml --json --duration 0.01").summary();
    let side = 512.0_f64.cbrt();
    assert_eq!(summary["box"]["lower"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_relative_eq!(summary["box"]["upper"][2].as_f64().unwrap(), side, max_relative = 1e-12);
    let summary = Folder::with(BOX).says("run scene.toml --json --duration 0.1").summary();
    assert_eq!((summary.get("box"), summary.get("statistics")), (None, None));
}

#[test]
fn an_equilibration_that_leaves_nothing_is_refused() {
    let folder = Folder::with(FLUID);
    for (time, words) in [("1", "is 1.0"), ("-1", "is -1.0"), ("nan", "is NaN")] {
        let run = format!("run scene.toml --state end.csv --set equilibrate={time}");
        let message = folder.says(&run).fails_with(2);
        assert!(message.contains("--set equilibrate") && message.contains(words), "{message}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}
