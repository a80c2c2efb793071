//! The order of the layers: a module imports what stands below it, never what
//! stands above.

use std::fs;
use std::path::{Path, PathBuf};

/// From the bottom up. Modules of one entry may import each other.
const LAYERS: [&[&str]; 12] = [
    &["numbers", "compensated", "lane", "mat3", "real", "trigonometry", "vec3"],
    &["column", "bodies", "workers"],
    &["motion"],
    &["contact"],
    &["space"],
    &["surroundings"],
    &["scene"],
    &["engine"],
    &["observe"],
    &["output"],
    &["study"],
    &["cli", "main"],
];

#[test]
fn imports_go_down() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&src, &mut files);
    let mut checked = 0;
    for file in files {
        let relative = file.strip_prefix(&src).unwrap();
        let first = relative.iter().next().unwrap().to_str().unwrap();
        let module = first.strip_suffix(".rs").unwrap_or(first);
        if module == "lib" {
            continue;
        }
        let own = layer(module);
        for (number, line) in fs::read_to_string(&file).unwrap().lines().enumerate() {
            let code = line.trim_start();
            if code.starts_with("//") {
                continue;
            }
            for imported in imports(code) {
                checked += 1;
                assert!(
                    layer(imported) <= own,
                    "{}:{}: {module} imports {imported}, which stands above it",
                    relative.display(),
                    number + 1,
                );
            }
        }
    }
    assert!(checked > 500, "only {checked} imports were found");
}

/// The modules of this crate that a line of code names.
fn imports(code: &str) -> impl Iterator<Item = &str> {
    ["crate::", "carom::"].into_iter().flat_map(move |root| {
        code.match_indices(root).filter_map(move |(at, _)| {
            let name = &code[at + root.len()..];
            let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            let name = &name[..end.unwrap_or(name.len())];
            name.starts_with(|c: char| c.is_ascii_lowercase()).then_some(name)
        })
    })
}

fn layer(module: &str) -> usize {
    let layer = LAYERS.iter().position(|modules| modules.contains(&module));
    layer.unwrap_or_else(|| panic!("{module} has no layer"))
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// The files of `scene/`, each of which imports only those before it.
const SCENE: [&str; 31] = [
    "settings",
    "spheres",
    "inlet",
    "random",
    "error",
    "lines",
    "assignment",
    "origin",
    "description",
    "check",
    "figures",
    "filling",
    "obstacles",
    "arrangement",
    "generate",
    "check_bodies",
    "checked",
    "coming",
    "quick",
    "builder",
    "builtin",
    "raw",
    "pieces",
    "reading",
    "state_file",
    "fixed",
    "entries",
    "file",
    "outputs",
    "source",
    "dilated",
];

#[test]
fn a_scene_is_made_in_one_direction() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/scene");
    let order = |name: &str| SCENE.iter().position(|file| *file == name);
    let mut checked = 0;
    for (own, file) in SCENE.iter().enumerate() {
        let text = fs::read_to_string(folder.join(format!("{file}.rs"))).unwrap();
        for line in text.lines().filter(|line| line.starts_with("use super::")) {
            let names = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            for imported in names.skip(2).filter_map(order) {
                checked += 1;
                assert!(imported < own, "scene/{file}.rs imports what comes after it: {line}");
            }
        }
    }
    assert!(checked > 30, "only {checked} imports were found");
}
