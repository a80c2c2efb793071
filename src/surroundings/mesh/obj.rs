//! OBJ: vertices and faces as lines of text.
//!
//! ```text
//! v X Y Z [W] [R G B]   a vertex
//! f A B C …             a face, by the numbers of its vertices from 1, or back from the last
//!                       one from -1; as A/T/N with those of a texture and a normal
//! ```

use super::MeshError;
use super::polygon::triangulated;
use super::words::{number, unexpected};

/// Words that begin lines without geometry of the surface.
const PASSED_OVER: [&str; 16] = [
    "vt",
    "vn",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
];

/// What a file has: vertices, and triangles by their numbers from 0.
#[derive(Default)]
pub(super) struct Obj {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Reads a file.
pub(super) fn read(bytes: &[u8]) -> Result<Obj, MeshError> {
    let Obj { mut vertices, mut triangles } = Obj::default();
    let mut last = 1;
    for (line, words) in lines(bytes) {
        last = line;
        let mut words = words.into_iter();
        let Some(keyword) = words.next() else { continue };
        match keyword {
            b"v" => vertices.push(vertex(line, &words.collect::<Vec<_>>())?),
            b"f" => {
                let corners = words.map(|word| corner(line, word, vertices.len()));
                let corners: Vec<u32> = corners.collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    let problem =
                        format!("a face of {} corners; it has three at least", corners.len());
                    return Err(MeshError::at_line(line, problem));
                }
                triangulated(&corners, &vertices, &mut triangles);
            }
            b"l" | b"p" => {
                let problem = "a line or a point, which no sphere can touch; a mesh is made of \
                               faces, so take it out of the file";
                return Err(MeshError::at_line(line, problem));
            }
            word if PASSED_OVER.iter().any(|passed| passed.as_bytes() == word) => {}
            word => {
                return Err(unexpected(line, word, "\"v\", \"f\" or another word of OBJ files"));
            }
        }
    }
    if triangles.is_empty() {
        return Err(MeshError::at_line(last, "the file ends here, and has no faces"));
    }
    Ok(Obj { vertices, triangles })
}

/// The lines of a text with their numbers, as words: comments left out, and lines that end in
/// `\` put together with the next one.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<&[u8]>)> {
    let mut rest = bytes.split(|&byte| byte == b'\n').enumerate();
    core::iter::from_fn(move || {
        let (first, mut line) = rest.next()?;
        let mut words = Vec::new();
        loop {
            let end = line.iter().position(|&byte| byte == b'#').unwrap_or(line.len());
            let code = line[..end].trim_ascii();
            let goes_on = code.last() == Some(&b'\\');
            let code = code.strip_suffix(b"\\").unwrap_or(code);
            let split = code.split(u8::is_ascii_whitespace);
            words.extend(split.filter(|word| !word.is_empty()));
            match if goes_on { rest.next() } else { None } {
                Some((_, next)) => line = next,
                None => return Some((first + 1, words)),
            }
        }
    })
}

/// Three coordinates, which a weight or a colour or both may follow.
fn vertex(line: usize, words: &[&[u8]]) -> Result<[f64; 3], MeshError> {
    if ![3, 4, 6, 7].contains(&words.len()) {
        let problem = format!(
            "a vertex of {} numbers; it has three, and may have a weight, a colour or both",
            words.len()
        );
        return Err(MeshError::at_line(line, problem));
    }
    let mut numbers = [0.0; 7];
    for (value, word) in numbers.iter_mut().zip(words) {
        *value = number(line, word, f64::is_finite)?;
    }
    Ok([numbers[0], numbers[1], numbers[2]])
}

/// The number of a vertex from 0, of those up to here.
fn corner(line: usize, word: &[u8], vertices: usize) -> Result<u32, MeshError> {
    let own = word.split(|&byte| byte == b'/').next().unwrap_or(word);
    let parsed = str::from_utf8(own).ok().and_then(|own| own.parse::<i64>().ok());
    let given = parsed.ok_or_else(|| unexpected(line, word, "the number of a vertex"))?;
    let count = vertices as i64;
    let index = if given < 0 { count.saturating_add(given) } else { given - 1 };
    if given != 0 && (0..count).contains(&index) {
        return u32::try_from(index)
            .map_err(|_| MeshError::at_line(line, "a mesh has fewer than 2^32 vertices"));
    }
    let problem = format!(
        "a face has the vertex {given}, and there are {vertices} up to here; they count from 1, \
         or back from -1"
    );
    Err(MeshError::at_line(line, problem))
}
