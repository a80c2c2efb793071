//! STL: triangles by their corners, in binary or as text.
//!
//! ```text
//! binary  80 bytes of anything · the number of triangles, 4 bytes ·
//!         50 bytes each: normal and three corners as f32, little-endian, and 2 more bytes
//! text    solid NAME
//!           facet normal X Y Z   outer loop
//!             vertex X Y Z   vertex X Y Z   vertex X Y Z
//!           endloop   endfacet
//!         endsolid NAME
//! ```
//!
//! Many programs leave `endsolid` out, and a text that is cut off between two triangles has
//! none either: without it, only a closed surface is taken for whole.
//!
//! A file whose length is what its number of triangles says is binary, whatever it begins
//! with.

use super::MeshError;
use super::words::{Words, unexpected};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;
/// Of a triangle, before its corners.
const NORMAL: usize = 12;

/// Where a triangle of a binary file begins.
pub(super) fn byte_of(triangle: usize) -> usize {
    HEADER + triangle * TRIANGLE
}

/// What a file has.
pub(super) struct Stl {
    /// The corners of all triangles, one after another.
    pub(super) corners: Vec<[f64; 3]>,
    pub(super) is_binary: bool,
    /// The last line of a text that ends before its `endsolid`.
    pub(super) ends_early: Option<usize>,
}

/// Reads a file.
pub(super) fn read(bytes: &[u8]) -> Result<Stl, MeshError> {
    let count = triangles_said(bytes);
    let is_whole = count.is_some_and(|count| wanted_length(count) == bytes.len() as u64);
    if is_whole || !starts_as_text(bytes) {
        let corners = binary(bytes, count)?;
        Ok(Stl { corners, is_binary: true, ends_early: None })
    } else {
        text(bytes)
    }
}

/// The number of triangles that a binary file says it has.
fn triangles_said(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

fn wanted_length(count: u32) -> u64 {
    HEADER as u64 + u64::from(count) * TRIANGLE as u64
}

fn starts_as_text(bytes: &[u8]) -> bool {
    let word = bytes.trim_ascii_start().get(..5);
    word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn binary(bytes: &[u8], count: Option<u32>) -> Result<Vec<[f64; 3]>, MeshError> {
    let length = bytes.len();
    let Some(count) = count else {
        let problem = format!(
            "the file ends here; a binary STL file has {HEADER} bytes at least, and one of text \
             begins with \"solid\""
        );
        return Err(MeshError::at_byte(length, problem));
    };
    let wanted = wanted_length(count);
    if wanted != length as u64 {
        let problem = format!(
            "it says that there are {count} triangles, which are {wanted} bytes, and the file has \
             {length}"
        );
        return Err(MeshError::at_byte(HEADER - 4, problem));
    }
    if count == 0 {
        return Err(MeshError::at_byte(HEADER - 4, "it says that there are no triangles"));
    }
    let mut corners = Vec::with_capacity(3 * count as usize);
    for (triangle, record) in bytes[HEADER..].chunks_exact(TRIANGLE).enumerate() {
        for (corner, place) in record[NORMAL..TRIANGLE - 2].chunks_exact(12).enumerate() {
            let mut numbers = [0.0; 3];
            for (axis, bytes) in place.chunks_exact(4).enumerate() {
                let value = bytes.try_into().map_or(f32::NAN, f32::from_le_bytes);
                if !value.is_finite() {
                    let byte = byte_of(triangle) + NORMAL + 12 * corner + 4 * axis;
                    let problem = format!(
                        "a coordinate of triangle {triangle} is {value}; it must be finite"
                    );
                    return Err(MeshError::at_byte(byte, problem));
                }
                numbers[axis] = f64::from(value);
            }
            corners.push(numbers);
        }
    }
    Ok(corners)
}

fn text(bytes: &[u8]) -> Result<Stl, MeshError> {
    let mut words = Words::new(bytes);
    let mut corners = Vec::new();
    loop {
        words.expect("solid")?;
        // A name may have any words.
        words.end_line();
        loop {
            match words.next() {
                None => return done(corners, words.line(), false),
                Some((_, word)) if word.eq_ignore_ascii_case(b"facet") => {
                    words.expect("normal")?;
                    for _ in 0..3 {
                        // Many programs write normals that are no numbers.
                        words.number(|_| true)?;
                    }
                    words.expect("outer")?;
                    words.expect("loop")?;
                    for _ in 0..3 {
                        words.expect("vertex")?;
                        let mut place = [0.0; 3];
                        for component in &mut place {
                            *component = words.number(f64::is_finite)?;
                        }
                        corners.push(place);
                    }
                    words.expect("endloop")?;
                    words.expect("endfacet")?;
                }
                Some((_, word)) if word.eq_ignore_ascii_case(b"endsolid") => {
                    words.end_line();
                    break;
                }
                Some((line, word)) => {
                    return Err(unexpected(line, word, "\"facet\" or \"endsolid\""));
                }
            }
        }
        if words.is_at_end() {
            return done(corners, words.line(), true);
        }
    }
}

fn done(corners: Vec<[f64; 3]>, line: usize, is_ended: bool) -> Result<Stl, MeshError> {
    if corners.is_empty() {
        return Err(MeshError::at_line(line, "the file ends here, and has no triangles"));
    }
    let ends_early = (!is_ended).then_some(line);
    Ok(Stl { corners, is_binary: false, ends_early })
}
