//! Analyses in a run, and of recorded frames.

use std::fs;

use crate::{FLUID, Folder, rows};

/// All kinds that frames can have.
const OF_FRAMES: [&str; 6] = [
    "radial-distribution",
    "mean-squared-displacement",
    "velocity-autocorrelation",
    "speed-distribution",
    "bond-order",
    "structure-factor",
];

/// The fluid with an analysis of each kind.
fn analysed(every: f64) -> Folder {
    let mut text = FLUID.to_owned();
    for kind in OF_FRAMES.into_iter().chain(["collision-statistics"]) {
        text += &format!("[[analyse]]\nkind = \"{kind}\"\nevery = {every:?}\n");
    }
    Folder::with(&text)
}

#[test]
fn analyses_change_no_bit_and_say_what_they_found() {
    for (engine, precision) in
        [("event-driven", "f64"), ("stepped", "f64"), ("event-driven", "f32")]
    {
        let run = format!("run scene.toml --json --engine {engine} --precision {precision}");
        let plain = Folder::with(FLUID).says(&run).summary();
        let folder = analysed(0.02);
        let with = folder.says(&run).summary();
        for key in ["state_hash", "collisions", "energy", "momentum", "compressibility"] {
            assert_eq!(with[key], plain[key], "{engine} {precision}: {key}");
        }
        assert_eq!(plain.get("analyses"), None);
        let found = with["analyses"].as_array().unwrap();
        assert_eq!(found.len(), 7);
        for (found, kind) in found.iter().zip(OF_FRAMES) {
            assert_eq!(found["kind"], kind);
            assert_eq!(found["file"], format!("scene-{kind}.csv"));
            assert_eq!(found["looks"], 51);
        }
        // A collision is the end of two flights; those under way at an end do not count, and
        // these are longer.
        let flights = &found[6]["figures"]["mean_free_time"]["mean"];
        let rate = with["collision_rate"].as_f64().unwrap();
        let product = flights.as_f64().unwrap() * rate;
        assert!((0.6..1.0).contains(&product), "{product}");
        let (names, table) = rows(&folder.path("scene-radial-distribution.csv"));
        assert_eq!(names, ["r", "g", "error"]);
        assert_eq!(table.len(), 200);
        assert!(!folder.names().iter().any(|name| name.contains("tmp")));
    }
    // For a person.
    let folder = analysed(0.05);
    let text = folder.says("run scene.toml --engine event-driven").well();
    assert!(text.contains("radial-distribution") && text.contains("  contact"), "{text}");
}

#[test]
fn frames_have_what_the_run_has() {
    let folder = analysed(0.02);
    let record = |name: &str| {
        let run = "run scene.toml --engine event-driven --record-every 0.02 --record";
        folder.says(&format!("{run} {name}")).well();
    };
    record("run.npz");
    let text = folder.says("analyse run.npz --plot").well();
    assert!(text.contains("run-bond-order.csv"), "{text}");
    for kind in OF_FRAMES {
        let (own, of_frames) = (format!("scene-{kind}.csv"), format!("run-{kind}.csv"));
        assert!(folder.read(&own) == folder.read(&of_frames), "{kind}");
        assert!(folder.read(&format!("run-{kind}.svg")).starts_with("<svg"));
    }
    // So has a table, under a name of its own.
    record("table.parquet");
    folder.says("analyse table.parquet").well();
    for kind in OF_FRAMES {
        let of_frames = format!("table-{kind}.csv");
        assert!(folder.read(&format!("run-{kind}.csv")) == folder.read(&of_frames), "{kind}");
    }
    // Texts have all digits; a dump has no times.
    record("text.dump");
    record("text.xyz");
    fs::create_dir(folder.path("dump")).unwrap();
    folder.says("analyse text.dump --every 0.02 -o dump").well();
    folder.says("analyse text.xyz").well();
    for kind in OF_FRAMES {
        let own = folder.read(&format!("scene-{kind}.csv"));
        assert!(own == folder.read(&format!("text-{kind}.csv")), "{kind}");
        if !["mean-squared-displacement", "velocity-autocorrelation"].contains(&kind) {
            assert!(own == folder.read(&format!("dump/text-{kind}.csv")), "{kind}");
        }
    }
    let message = folder.says("analyse text.dump").fails_with(2);
    assert!(message.contains("--every TIME"), "{message}");
    // Some of the frames, some of the kinds.
    let some =
        "analyse run.npz --kind radial-distribution --bins 20 --range 0.5,2 --from 0.9 -o dump";
    let text = folder.says(some).well();
    assert!(text.contains("6 looks"), "{text}");
    let (_, table) = rows(&folder.path("dump/run-radial-distribution.csv"));
    assert_eq!((table.len(), table[0][1].as_str()), (20, "0.0"));
}

#[test]
fn frames_in_open_space_have_no_box() {
    let folder = Folder::with(crate::BOX);
    folder.says("run scene.toml --record run.xyz --record-every 0.1").well();
    let text = folder.says("analyse run.xyz --species 2").well();
    assert!(text.contains("left out  radial-distribution"), "{text}");
    assert!(folder.path("run-speed-distribution.csv").exists());
    let message = folder.says("analyse run.xyz --kind bond-order").fails_with(2);
    assert!(message.contains("--kind is in open space"), "{message}");
    let message = folder.says("analyse run.xyz --species 3").fails_with(2);
    assert!(
        message.contains("--species is [3]; it is one or two of the species 1 to 2"),
        "{message}"
    );
}

#[test]
fn a_run_that_goes_on_finds_what_one_run_finds() {
    for engine in ["event-driven", "stepped"] {
        let folder = analysed(0.05);
        let run = format!("run scene.toml --json --engine {engine} --set equilibrate=0.11");
        let whole = folder.says(&run).summary();
        let kinds = || OF_FRAMES.into_iter().chain(["collision-statistics"]);
        let files = || kinds().map(|kind| folder.read(&format!("scene-{kind}.csv")));
        let before: Vec<String> = files().collect();
        folder.says(&format!("{run} --duration 0.4 --snapshot kept.snapshot")).summary();
        assert!(files().zip(&before).any(|(now, before)| now != *before));
        let end = "run --resume kept.snapshot --json --duration 1 --threads 2 --lanes 4";
        let end = folder.says(end).summary();
        for key in ["state_hash", "analyses"] {
            assert_eq!(end[key], whole[key], "{engine}: {key}");
        }
        assert!(files().eq(before), "{engine}");
    }
}

#[test]
fn damaged_and_foreign_frames_are_refused_with_their_place() {
    let folder = Folder::with(FLUID);
    let run = "run scene.toml --engine event-driven --duration 0.1 --record-every 0.05 --record";
    for name in ["run.dump", "run.xyz", "run.npz"] {
        folder.says(&format!("{run} {name}")).well();
    }
    let says = |name: &str, bytes: &[u8]| {
        fs::write(folder.path(name), bytes).unwrap();
        let message = folder.says(&format!("analyse {name} --kind speed-distribution"));
        let message = message.fails_with(1);
        assert!(!folder.names().iter().any(|name| name.contains("speed")), "{message}");
        message
    };
    let dump = folder.read("run.dump");
    // Nine lines of a head, 256 bodies.
    let cut = dump.match_indices('\n').nth(300).unwrap().0;
    let message = says("cut.dump", &dump.as_bytes()[..cut + 1]);
    assert!(message.contains("cut.dump:302: the file ends in the middle of a frame"), "{message}");
    let second = dump.replacen("\n2 1 0.5 ", "\n2 1 half ", 1);
    let message = says("word.dump", second.as_bytes());
    assert!(message.contains("word.dump:11: radius: \"half\" stands where a number"), "{message}");
    let message = says("twice.dump", dump.replacen("\n2 1 0.5 ", "\n1 1 0.5 ", 1).as_bytes());
    assert!(message.contains("two bodies of a frame have the id 1"), "{message}");
    let message = says("other.dump", b"Hello\n");
    assert!(message.contains("other.dump:1: \"Hello\" stands where an ITEM:"), "{message}");
    let message = says("great.dump", dump.replacen("\n256\n", "\n99999999999\n", 1).as_bytes());
    assert!(message.contains("great.dump:4: a frame of 99999999999 bodies"), "{message}");
    let message = says("fewer.dump", dump.replacen("\n256\n", "\n255\n", 1).as_bytes());
    assert!(message.contains("fewer.dump:265: "), "{message}");

    let xyz = folder.read("run.xyz");
    let message = says("plain.xyz", b"1\nwater\nH 0 0 0\n");
    assert!(message.contains("plain.xyz:2: there are no Properties"), "{message}");
    let message = says("short.xyz", xyz.replacen("radius:R:1:", "", 1).as_bytes());
    assert!(message.contains("short.xyz:2: there is no radius"), "{message}");
    let message = says("side.xyz", xyz.replacen("T T T", "T T F", 1).as_bytes());
    assert!(message.contains("side.xyz:2: space is periodic along some sides only"), "{message}");

    let npz = fs::read(folder.path("run.npz")).unwrap();
    let message = says("cut.npz", &npz[..npz.len() / 2]);
    assert!(message.contains("cut.npz: is no whole archive of NumPy"), "{message}");
    let mut flipped = npz.clone();
    flipped[3000] ^= 1;
    let message = says("flipped.npz", &flipped);
    assert!(message.contains("flipped.npz: byte ") && message.contains("checksum"), "{message}");
    let message = says("text.npz", dump.as_bytes());
    assert!(message.contains("text.npz: is no whole archive"), "{message}");
    let message = says("empty.npz", b"");
    assert!(message.contains("empty.npz: is no whole archive"), "{message}");

    let message = folder.says("analyse run.pvd").fails_with(2);
    assert!(
        message.contains("its ending must be .dump, .lammpstrj, .xyz, .extxyz, .npz or .parquet")
    );
    let message = folder.says("analyse nowhere.dump").fails_with(1);
    assert!(message.contains("nowhere.dump: cannot be read"), "{message}");
    fs::write(folder.path("empty.dump"), "").unwrap();
    let message = folder.says("analyse empty.dump").fails_with(2);
    assert!(message.contains("empty.dump has no frames"), "{message}");
}

#[test]
fn mistakes_in_the_scene_are_named() {
    let says = |keys: &str| {
        let folder = Folder::with(&format!("{FLUID}\n[[analyse]]\n{keys}\n"));
        let message = folder.says("run scene.toml").fails_with(2);
        assert_eq!(folder.names(), ["scene.toml"]);
        message
    };
    // The entry begins on line 15, its keys on 16.
    for (keys, expected) in [
        ("every = 1", "scene.toml:15: analyse[0].kind is missing; it must be one of \"radial"),
        ("kind = \"radial\"", "scene.toml:16: analyse[0].kind is `radial`"),
        ("kind = \"bond-order\"\nbin = 3", "scene.toml:17: analyse[0].bin is not a key"),
        ("kind = \"bond-order\"\nevery = 0", "scene.toml:17: analyse[0].every is 0.0; a time"),
        ("kind = \"bond-order\"\nrange = 5", "scene.toml:17: analyse[0].range is 5.0; neighbours"),
        (
            "kind = \"bond-order\"\nspecies = [2]",
            "scene.toml:17: analyse[0].species is [2]; it is one of the species 1 to 1, as [1]",
        ),
        ("kind = \"bond-order\"\nfile = \"a.txt\"", "scene.toml:17: analyse[0].file is \"a.txt\""),
        (
            "kind = \"bond-order\"\n[[analyse]]\nkind = \"bond-order\"",
            "analyse[1].file is \"scene-bond-order.csv\"; that is the file of analyse[0]",
        ),
    ] {
        let message = says(keys);
        assert!(message.contains(expected), "{message}");
    }
}
