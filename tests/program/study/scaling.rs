//! `carom study scaling`.

use crate::{BOX, FLUID, Folder};

#[test]
fn a_study_fills_its_folder_and_is_resumed() {
    let folder = Folder::with(FLUID);
    let tiny = "study scaling scene.toml --bodies 108,500 --runs 1 --threads 1,2 --lanes auto,4 \
                --precision f64 --output s";
    let text = folder.says(tiny).well();
    for words in ["f64, 108 bodies", "f64, 500 bodies", "p = ", "same bits", "are in s."] {
        assert!(text.contains(words), "{words} is missing:\n{text}");
    }
    let report = folder.read("s/report.txt");
    assert!(text.starts_with(&report));
    assert_eq!(folder.read("s/scene.toml"), FLUID);
    // All points are there: nothing is measured again.
    assert_eq!(folder.says(tiny).well(), text);
    let other = folder.says(&tiny.replace("--runs 1", "--runs 2")).fails_with(2);
    assert!(other.contains("--output"), "{other}");
    folder.says(&format!("{} --restart", tiny.replace("--runs 1", "--runs 2"))).well();
}

#[test]
fn absurd_arguments_are_mistakes() {
    let folder = Folder::with(BOX);
    for (arguments, words) in [
        ("--bodies 0", "--bodies"),
        ("--bodies 1000000000000", "--bodies"),
        ("--bodies 10,", "--bodies"),
        ("--bodies=-3", "--bodies"),
        ("--threads 5000", "--threads"),
        ("--threads 0", "--threads"),
        ("--runs 0", "--runs"),
        ("--lanes 3", "--lanes"),
        ("--precision f16", "--precision"),
        ("--bodies 1", "more are needed than the 1 with a `position`"),
        ("--bodies 100 --output no/such/folder", "no/such/folder"),
        ("--bodies 2 --dt 0", "--dt"),
    ] {
        let message = folder.says(&format!("study scaling scene.toml {arguments}")).fails_with(2);
        assert!(message.contains(words), "{arguments}: {message}");
    }
    let message = folder.says("study scaling pi").fails_with(2);
    assert!(message.contains("no group with a `count`"), "{message}");
    folder.says("study scaling nowhere.toml").fails_with(2);
    assert_eq!(folder.names(), ["scene.toml"]);
}
