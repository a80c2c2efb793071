//! Motion as a page for a browser: the data in it are those of the frames.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use carom::output::FrameReader;
use serde_json::Value;

use crate::{BOX, FLUID, Folder};

/// What a page holds.
struct Page {
    text: String,
    header: Value,
}

impl Page {
    fn of(folder: &Folder, name: &str) -> Self {
        let text = folder.read(name);
        let header = serde_json::from_str(part(&text, "header").unwrap()).unwrap();
        Self { text, header }
    }

    fn bytes(&self, id: &str) -> Vec<u8> {
        STANDARD.decode(part(&self.text, id).unwrap_or_else(|| panic!("no {id}"))).unwrap()
    }

    fn floats(&self, id: &str) -> Vec<f32> {
        let bytes = self.bytes(id);
        bytes.chunks_exact(4).map(|it| f32::from_le_bytes(it.try_into().unwrap())).collect()
    }

    fn counts(&self) -> Vec<u64> {
        self.header["counts"].as_array().unwrap().iter().map(|it| it.as_u64().unwrap()).collect()
    }
}

/// The text of an element.
fn part<'a>(text: &'a str, id: &str) -> Option<&'a str> {
    let (_, behind) = text.split_once(&format!("id=\"{id}\">"))?;
    behind.split_once("</script>").map(|(inside, _)| inside)
}

/// The positions of all frames of a file.
fn recorded(folder: &Folder, name: &str) -> Vec<f32> {
    let frames = FrameReader::open(&folder.path(name)).unwrap().map(Result::unwrap);
    let places = frames.flat_map(|frame| {
        let bodies = frame.bodies;
        (0..bodies.len()).flat_map(move |k| bodies.position_of(k).to_array()).collect::<Vec<_>>()
    });
    places.map(|place| place as f32).collect()
}

#[test]
fn a_page_has_the_places_of_the_frames() {
    for (scene, engine) in [(BOX, "stepped"), (BOX, "event-driven"), (FLUID, "event-driven")] {
        let folder = Folder::with(scene);
        let options = format!("scene.toml --engine {engine} --duration 0.5");
        folder.says(&format!("run {options} --json --record run.npz --record-every 0.0625")).well();
        let said = folder.says(&format!("view {options} --frames 8")).well();
        assert!(said.starts_with("scene.html: 9 frames, "), "{said}");
        let page = Page::of(&folder, "scene.html");
        assert_eq!(page.floats("positions"), recorded(&folder, "run.npz"));
        assert_eq!(page.header["times"].as_array().unwrap().len(), 9);
        assert_eq!(page.header["origin"], serde_json::json!([0.0, 0.0, 0.0]));

        // The same from the frames.
        for ending in ["npz", "dump", "xyz", "parquet"] {
            let record = format!("run {options} --json --record it.{ending} --record-every 0.0625");
            folder.says(&record).well();
            folder.says(&format!("view it.{ending}")).well();
            let again = Page::of(&folder, "it.html");
            for id in ["positions", "speeds", "radii", "kinds"] {
                assert_eq!(again.bytes(id), page.bytes(id), "{ending}: {id}");
            }
            assert_eq!(again.header["counts"], page.header["counts"]);
            assert_eq!(again.header["box"], page.header["box"]);
            if scene == BOX {
                assert_eq!(again.bytes("turns"), page.bytes("turns"), "{ending}");
            }
        }
    }
}

#[test]
fn a_page_is_whole() {
    let folder = Folder::with(BOX);
    folder.says("view scene.toml --frames 4 -o it.html").well();
    assert_eq!(folder.names(), ["it.html", "scene.toml"]);
    let page = Page::of(&folder, "it.html");
    // Nothing is fetched from elsewhere, and no place of the page is left open.
    for word in ["http", "import(", "@import", "src=", "href", "{{"] {
        assert!(!page.text.contains(word), "{word}");
    }
    assert_eq!(page.counts(), [20; 5]);
    assert_eq!(page.floats("radii")[..2], [0.5, 0.3]);
    assert_eq!(page.bytes("kinds")[..3], [0, 1, 1]);
    // A box of twelve triangles and as many edges.
    assert_eq!(page.header["faces"], serde_json::json!([12, 0, 0, 0]));
    assert_eq!(page.floats("faces").len(), 12 * 9);
    assert_eq!(page.floats("edges").len(), 12 * 6);
    // Orientations are unit quaternions.
    let turns = page.bytes("turns");
    assert_eq!(turns.len(), 5 * 20 * 8);
    for turn in turns.chunks_exact(8) {
        let parts = turn.chunks_exact(2).map(|it| i16::from_le_bytes([it[0], it[1]]));
        let length = parts.map(|it| (f64::from(it) / 32767.0).powi(2)).sum::<f64>();
        assert!((length - 1.0).abs() < 1e-4, "{length}");
    }
    assert!(page.bytes("speeds").contains(&255));
}

#[test]
fn frames_are_thinned_to_a_limit() {
    let folder = Folder::with(&FLUID.replace("count = 256", "count = 2048"));
    let said = folder.says("view scene.toml --duration 0.1 --frames 50 --limit 1").well();
    // A frame takes some 36 kB.
    assert!(said.contains("26 frames, one of each 2, 2048 spheres"), "{said}");
    assert_eq!(Page::of(&folder, "scene.html").counts(), [2048; 26]);
    folder.says("run scene.toml --json --duration 0.1 --record a.npz --record-every 0.01").well();
    let said = folder.says("view a.npz --frames 5").well();
    assert!(said.contains("6 frames, one of each 2"), "{said}");
    let folder = Folder::with(&FLUID.replace("count = 256", "count = 70000"));
    let message = folder.says("view scene.toml --limit 1").fails_with(2);
    assert!(message.contains("--limit is 1"), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn spheres_may_come_and_go() {
    let scene = "duration = 2.0\n[[inlet]]\nposition = [0, 0, 0]\nradius = 0.1\nrate = 4\nvelocity = [0, 0, 1]\n\
                 [[surroundings]]\nshape = \"plane\"\npoint = [0, 0, 1]\nnormal = [0, 0, -1]\nremoves = true\n";
    let folder = Folder::with(scene);
    folder.says("view scene.toml --frames 8").well();
    let page = Page::of(&folder, "scene.html");
    let counts = page.counts();
    assert!(counts.len() == 9 && counts.windows(2).any(|pair| pair[0] != pair[1]), "{counts:?}");
    assert_eq!(page.header["varies"], true);
    let all = counts.iter().sum::<u64>() as usize;
    assert_eq!((page.floats("positions").len(), page.floats("radii").len()), (3 * all, all));
    // A plane goes as far as what is seen.
    assert!(page.header["faces"][0].as_u64().unwrap() >= 2);
}

#[test]
fn mistakes_are_named() {
    let folder = Folder::with(BOX);
    std::fs::write(folder.path("end.csv"), "x,y,z,radius\n1,2,3,1\n").unwrap();
    std::fs::write(folder.path("bad.xyz"), "3\nnothing\n").unwrap();
    std::fs::write(folder.path("none.xyz"), "").unwrap();
    std::fs::write(folder.path("run.pvd"), "").unwrap();
    let before = folder.names();
    for (arguments, status, words) in [
        ("no.toml", 2, "no.toml"),
        ("superbal", 2, "Did you mean `superball`?"),
        ("no.npz", 1, "no.npz"),
        ("bad.xyz", 1, "bad.xyz:2"),
        ("none.xyz", 2, "has no frame"),
        ("run.pvd", 2, "run.pvd"),
        ("end.csv", 2, "`carom picture`"),
        ("bad.xyz --engine stepped", 2, "--engine is for a scene"),
        ("bad.xyz --duration 1", 2, "--duration is for a scene"),
        ("scene.toml -o it.svg", 2, "ending must be .html"),
        ("scene.toml -o it", 2, "ending must be .html"),
        ("scene.toml -o no/it.html", 2, "there is no folder no"),
        ("scene.toml --frames 0", 2, "--frames"),
        ("scene.toml --limit 0", 2, "--limit"),
        ("scene.toml --duration 0", 2, "--duration"),
        ("scene.toml --duration 1e300", 2, "2^53"),
    ] {
        let message = folder.says(&format!("view {arguments}")).fails_with(status);
        assert!(message.contains(words), "{arguments}: {message}");
        assert_eq!(folder.names(), before, "{arguments}");
    }
}
