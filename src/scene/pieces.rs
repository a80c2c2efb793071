//! Pieces: a long scene file is read piece by piece. The TOML library keeps some
//! kilobytes for each entry while it reads, and a file may have a million.

use rayon::prelude::*;
use serde::Deserialize;
use toml::de::DeTable;

use super::assignment::{self, Assignment, Refused};
use super::raw::{RawScene, RawSpheres};

/// Entries from which a file is read in pieces, and how many a piece has.
const MANY: usize = 2048;

/// How an entry of spheres begins.
const ENTRY: &str = "[[spheres]]";

/// Entries of spheres, and nothing else.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Piece {
    spheres: Vec<RawSpheres>,
}

/// Reads a scene file, with assignments in the place of its values.
pub(super) fn scene(text: &str, set: &[Assignment]) -> Result<RawScene, Refused> {
    // Whatever is out of the ordinary, mistakes among it, is read as a whole.
    in_pieces(text, set).map_or_else(|| assignment::read(text, set), Ok)
}

/// The scene, if its entries of spheres are many, stand one after the other, and
/// are right.
fn in_pieces(text: &str, set: &[Assignment]) -> Option<RawScene> {
    let starts = starts_of_entries(text)?;
    let (of_spheres, others): (Vec<&Assignment>, Vec<&Assignment>) =
        set.iter().partition(|assignment| assignment.is_of_spheres());
    if !of_spheres.iter().all(|set| set.entry().is_some_and(|entry| entry < starts.len())) {
        return None;
    }
    let (first, last) = (*starts.first()?, *starts.last()?);
    // After the last entry there may be other tables.
    let end = last + end_of_entry(&text[last..]);
    let mut rest = String::with_capacity(first + text.len() - end);
    rest.push_str(&text[..first]);
    rest.push_str(&text[end..]);
    if DeTable::parse(&rest).ok()?.get_ref().contains_key("spheres") {
        return None;
    }
    let others: Vec<Assignment> = others.into_iter().cloned().collect();
    let mut scene: RawScene = assignment::read(&rest, &others).ok()?;
    let pieces = starts.chunks(MANY).enumerate().map(|(piece, chunk)| {
        let next = starts.get((piece + 1) * MANY).copied();
        let first = piece * MANY;
        let is_here = |set: &&&Assignment| set.entry().is_some_and(|entry| entry / MANY == piece);
        let own = of_spheres.iter().filter(is_here).map(|set| set.after(first));
        (&text[chunk[0]..next.unwrap_or(end)], own.collect())
    });
    let pieces: Vec<(&str, Vec<Assignment>)> = pieces.collect();
    let read = |(piece, set): &(&str, Vec<Assignment>)| {
        assignment::read(piece, set).ok().map(|Piece { spheres }| spheres)
    };
    let pieces: Vec<Vec<RawSpheres>> = pieces.par_iter().map(read).collect::<Option<_>>()?;
    scene.spheres = Vec::with_capacity(starts.len());
    scene.spheres.extend(pieces.into_iter().flatten());
    Some(scene)
}

/// Where the entries of spheres start; `None` if there are few, or other tables
/// between them, or texts over several lines.
fn starts_of_entries(text: &str) -> Option<Vec<usize>> {
    if text.contains("\"\"\"") || text.contains("'''") {
        return None;
    }
    let mut starts = Vec::new();
    let mut has_ended = false;
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim_start();
        if trimmed.starts_with(ENTRY) {
            if has_ended {
                return None;
            }
            starts.push(offset);
        } else if trimmed.starts_with('[') && !starts.is_empty() {
            has_ended = true;
        }
        offset += line.len();
    }
    (starts.len() >= MANY).then_some(starts)
}

/// How long the entry is that a text starts with.
fn end_of_entry(text: &str) -> usize {
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        if offset > 0 && line.trim_start().starts_with('[') {
            return offset;
        }
        offset += line.len();
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(k: usize) -> String {
        format!("[[spheres]] # number {k}\nposition = [{k}.5, 0, 0]\nradius = 0.25\n\n")
    }

    #[test]
    fn pieces_make_the_same_scene() {
        for count in [MANY, MANY + 1, 2 * MANY, 3 * MANY - 1] {
            let entries: String = (0..count).map(entry).collect();
            let text =
                format!("duration = 1\n[surface]\nkind = \"rough\"\n{entries}[stepped]\ndt = 1\n");
            let whole: RawScene = toml::from_str(&text).unwrap();
            let pieces = in_pieces(&text, &[]).unwrap();
            assert_eq!(format!("{pieces:?}"), format!("{whole:?}"));
            assert_eq!(pieces.spheres.len(), count);
        }
    }

    #[test]
    fn assignments_find_their_entry_in_its_piece() {
        let text: String = (0..2 * MANY).map(entry).collect();
        let last = 2 * MANY - 1;
        let set = [format!("spheres[{last}].radius=3"), "duration=7".to_owned()];
        let set = set.map(|text| Assignment::parse(&text).unwrap_or_else(|_| panic!("{text}")));
        let pieces = in_pieces(&text, &set).unwrap();
        let whole: Option<RawScene> = assignment::read(&text, &set).ok();
        assert_eq!(format!("{:?}", Some(&pieces)), format!("{:?}", whole.as_ref()));
        let radius = format!("{:?}", pieces.spheres[last].radius);
        assert_eq!(radius, "Some(Same(3.0))");
        let beyond = Assignment::parse(&format!("spheres[{}].radius=3", last + 1));
        assert!(in_pieces(&text, &beyond.map_or_else(|_| vec![], |set| vec![set])).is_none());
    }

    #[test]
    fn what_is_out_of_the_ordinary_is_read_as_a_whole() {
        let entries: String = (0..MANY).map(entry).collect();
        assert!(in_pieces(&entries, &[]).is_some());
        for text in [
            entry(0),
            format!("{entries}[stepped]\ndt = 1\n{}", entry(0)),
            format!("spheres = []\n{entries}"),
            format!("{entries}position = [0, 0, 0]\n"),
            format!("{entries}[[spheres]]\nradus = 1\n"),
            format!("dt = \"\"\"\n\"\"\"\n{entries}"),
            format!("{entries}[periodic\n"),
        ] {
            assert!(in_pieces(&text, &[]).is_none());
        }
    }
}
