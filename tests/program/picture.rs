//! Still pictures.

use std::fs;

use crate::{BOX, FLUID, Folder};

/// How often a text has a piece.
fn count(text: &str, piece: &str) -> usize {
    text.matches(piece).count()
}

#[test]
fn a_scene_is_drawn() {
    let folder = Folder::with(BOX);
    folder.says("picture scene.toml").well();
    assert_eq!(folder.names(), ["scene.svg", "scene.toml"]);
    let svg = folder.read("scene.svg");
    assert!(svg.starts_with("<svg ") && svg.contains("width=\"640\""), "{}", &svg[..200]);
    // Twenty spheres, and one of each kind in the legend; five walls and their edges.
    assert_eq!(count(&svg, "<circle "), 22);
    assert_eq!(count(&svg, "mass 3</text>") + count(&svg, "mass 1</text>"), 2);
    assert!(count(&svg, "<path ") >= 6 + 12, "{svg}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"));

    // Later it is another picture, and the same each time.
    folder.says("picture scene.toml --at 0.5 -o later.svg --no-legend").well();
    folder.says("picture scene.toml --at 0.5 -o again.svg --no-legend --threads 1").well();
    assert_eq!(folder.read("later.svg"), folder.read("again.svg"));
    assert_eq!(count(&folder.read("later.svg"), "<circle "), 20);
    assert_ne!(folder.read("later.svg"), svg);
}

#[test]
fn a_state_and_frames_are_drawn_as_their_scene() {
    let folder = Folder::with(FLUID);
    let run = "run scene.toml --state end.csv --record run.npz --record-every 0.25";
    folder.says(&format!("{run} --json")).well();
    let look = "--no-legend --from 1,-2,0.5";
    folder.says(&format!("picture scene.toml --at 1 -o scene.svg {look}")).well();
    folder.says(&format!("picture run.npz -o frame.svg {look}")).well();
    assert_eq!(folder.read("scene.svg"), folder.read("frame.svg"));
    folder.says(&format!("picture run.npz --at 0.3 -o early.svg {look}")).well();
    folder.says(&format!("picture scene.toml --at 0.5 -o half.svg {look}")).well();
    assert_eq!(folder.read("early.svg"), folder.read("half.svg"));
    // A state says nothing of a box: without its twelve edges, three of them hidden.
    folder.says(&format!("picture end.csv {look}")).well();
    let [state, scene] = ["end.svg", "scene.svg"].map(|name| folder.read(name));
    assert_eq!(count(&state, "<path "), 0);
    assert!(count(&scene, "<path ") >= 9);
}

#[test]
fn a_picture_has_its_look() {
    let folder = Folder::with(BOX);
    folder.says("picture scene.toml -o a.png --width 300 --color speed --theme dark").well();
    let png = fs::read(folder.path("a.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    assert_eq!(u32::from_be_bytes([png[16], png[17], png[18], png[19]]), 600);
    folder.says("picture scene.toml -o b.svg --color speed --theme dark").well();
    folder.says("picture scene.toml -o c.svg --color spin --perspective 40 --up 0,1,0").well();
    let [b, c] = ["b.svg", "c.svg"].map(|name| folder.read(name));
    assert!(b.contains("fill=\"#121418\"") && b.contains(">speed "), "{b}");
    assert!(c.contains(">angular speed ") && c.contains("rotate("), "{c}");
}

/// All kinds of shape, in pictures without a place that is no number.
#[test]
fn all_built_in_scenes_are_drawn() {
    let folder = Folder::with("");
    for name in ["wedge", "newtons-cradle", "funnel", "hopper", "drum", "terrain", "ball-in-torus"]
    {
        folder.says(&format!("picture {name} -o it.svg --width 300")).well();
        let svg = folder.read("it.svg");
        assert!(count(&svg, "<path ") > 4, "{name}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        assert!(svg.len() < 4_000_000, "{name}: {} bytes", svg.len());
    }
}

#[test]
fn what_is_hidden_is_left_out() {
    let many = "[[surroundings]]\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [20, 20, 20]\ninside = true\n\
                [[spheres]]\ncount = 8000\narrangement = \"cubic\"\nradius = 0.499\n";
    let folder = Folder::with(many);
    folder.says("picture scene.toml --from 1,1,1").well();
    let circles = count(&folder.read("scene.svg"), "<circle ");
    // The three faces have 1141 of them.
    assert!((1141..4000).contains(&circles), "{circles}");
}

#[test]
fn mistakes_are_named() {
    let folder = Folder::with(BOX);
    fs::write(folder.path("bad.csv"), "x,y,z,radius\n1,2,three,1\n").unwrap();
    fs::write(folder.path("bare.csv"), "x,y,z\n1,2,3\n").unwrap();
    fs::write(folder.path("bad.npz"), "nothing").unwrap();
    fs::write(folder.path("run.pvd"), "").unwrap();
    folder.says("run scene.toml --json --record run.xyz --record-every 1 --duration 1").well();
    let before = folder.names();
    for (arguments, status, words) in [
        ("no.toml", 2, "no.toml"),
        ("superbal", 2, "Did you mean `superball`?"),
        ("no.csv", 2, "no.csv"),
        ("no.xyz", 1, "no.xyz"),
        ("bad.csv", 2, "bad.csv:2: column z"),
        ("bare.csv", 2, "radius"),
        ("bad.npz", 1, "bad.npz"),
        ("run.pvd", 2, "run.pvd"),
        ("scene.toml -o it.jpeg", 2, ".svg, .png or .pdf"),
        ("scene.toml -o it", 2, ".svg, .png or .pdf"),
        ("scene.toml -o no/it.svg", 2, "there is no folder no"),
        ("scene.toml -o /dev/null", 2, ".svg, .png or .pdf"),
        ("scene.toml --from 1,2", 2, "three numbers"),
        ("scene.toml --from 0,0,0", 2, "length above 0"),
        ("scene.toml --up 1,2,x", 2, "three numbers"),
        ("scene.toml --perspective 200", 2, "1 to 120"),
        ("scene.toml --width 3", 2, "--width"),
        ("scene.toml --color mass", 2, "species"),
        ("scene.toml --at -1", 2, "--at"),
        ("run.xyz --at 5", 2, "--at is 5.0"),
        ("run.xyz --dt 0.1", 2, "--dt is for a scene"),
    ] {
        let message = folder.says(&format!("picture {arguments}")).fails_with(status);
        assert!(message.contains(words), "{arguments}: {message}");
        assert_eq!(folder.names(), before, "{arguments}");
    }
    if cfg!(not(feature = "pdf")) {
        let message = folder.says("picture scene.toml -o it.pdf").fails_with(2);
        assert!(message.contains("--features pdf"), "{message}");
    }
}
