//! A series of ParaView: a `.pvd` file that names a `.vtp` file for each frame, with
//! arrays inline in base64, uncompressed.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::super::{Listed, WholeFile, is_single};
use super::Frame;
use super::figures::quaternion_of;
use crate::numbers::array::Each;
use crate::observe::species;
use crate::real::Real;

/// What a series begins with.
const HEAD: &str = "<?xml version=\"1.0\"?>\n\
                    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
                    <Collection>\n";

/// A series under way. The files of its frames are whole one by one; if the series does
/// not come to its end, they go, but for those that were kept.
#[derive(Debug)]
pub struct ParaView<W> {
    path: PathBuf,
    output: W,
    /// Frames that were kept.
    kept: usize,
    frames: Vec<Unfinished>,
}

/// A frame of a series that is not yet there.
#[derive(Debug)]
struct Unfinished {
    path: PathBuf,
    listed: Option<Listed>,
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if self.listed.is_some() {
            // What cannot be removed is named by no series.
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl<W: io::Write> ParaView<W> {
    pub fn new(path: &Path, mut output: W) -> io::Result<Self> {
        output.write_all(HEAD.as_bytes())?;
        Ok(Self { path: path.to_path_buf(), output, kept: 0, frames: Vec::new() })
    }

    /// Frames behind those of a series that was kept.
    pub fn resume(path: &Path, output: W, kept: &[u8]) -> io::Result<Self> {
        let kept = str::from_utf8(kept).ok().and_then(|kept| kept.parse().ok());
        let kept = kept.ok_or(io::ErrorKind::InvalidData)?;
        let series = Self { path: path.to_path_buf(), output, kept, frames: Vec::new() };
        let gone = (0..kept).map(|number| series.frame(number)).find(|path| !path.exists());
        gone.map_or(Ok(series), |gone| {
            let reason = format!("its frame {} is no longer there", gone.display());
            Err(io::Error::new(io::ErrorKind::NotFound, reason))
        })
    }

    /// The file of a frame.
    fn frame(&self, number: usize) -> PathBuf {
        let mut name = self.path.file_stem().map_or_else(OsString::new, OsString::from);
        name.push(format!("_{number:06}.vtp"));
        self.path.with_file_name(name)
    }

    /// Writes one frame into a file of its own.
    pub fn write<T: Real>(&mut self, frame: &Frame<'_, T>) -> io::Result<()> {
        is_single::<T>()?;
        let path = self.frame(self.kept + self.frames.len());
        let mut file = WholeFile::beside(&path)?;
        // Only names that are text can stand in XML.
        let name = path.file_name().and_then(|name| name.to_str());
        let name = escaped(name.ok_or(io::ErrorKind::InvalidFilename)?);
        write_points(&mut io::BufWriter::with_capacity(1 << 18, &mut file), frame)?;
        file.finish()?;
        self.frames.push(Unfinished { listed: Some(Listed::new(path.clone())), path });
        let entry = format!(
            "    <DataSet timestep=\"{:?}\" group=\"\" part=\"0\" file=\"{name}\"/>\n",
            frame.time
        );
        self.output.write_all(entry.as_bytes())
    }

    /// Lets the frames so far stay, and returns what [`resume`](Self::resume) needs: how many
    /// they are.
    pub fn keep(&mut self) -> io::Result<(&W, Vec<u8>)> {
        self.output.flush()?;
        self.stay();
        Ok((&self.output, self.kept.to_string().into_bytes()))
    }

    fn stay(&mut self) {
        self.kept += self.frames.len();
        for frame in &mut self.frames {
            frame.listed = None;
        }
        self.frames.clear();
    }

    /// Writes the series itself.
    pub fn finish(mut self) -> io::Result<W> {
        self.output.write_all(b"  </Collection>\n</VTKFile>\n")?;
        self.output.flush()?;
        self.stay();
        Ok(self.output)
    }
}

/// Text in an attribute of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// One frame as points with data. It has no field of the time, with which OVITO does
/// not know the file as its own.
fn write_points<T: Real, W: io::Write>(output: &mut W, frame: &Frame<'_, T>) -> io::Result<()> {
    let bodies = frame.bodies;
    let count = bodies.len();
    writeln!(
        output,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n    \
         <Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" \
         NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n    <Points>"
    )?;
    let each = || 0..count;
    let vectors =
        |of: &dyn Fn(usize) -> [T; 3]| each().flat_map(of).collect::<Vec<T>>().into_iter();
    array(output, "Points", 3, vectors(&|k| bodies.position_of(k).to_array()))?;
    writeln!(output, "    </Points>\n    <Verts>")?;
    array(output, "connectivity", 1, each().map(|k| k as i64))?;
    array(output, "offsets", 1, each().map(|k| k as i64 + 1))?;
    writeln!(output, "    </Verts>\n    <PointData>")?;
    array(output, "id", 1, each().map(|k| frame.number(k)))?;
    array(output, "type", 1, species(bodies).into_iter().map(i64::from))?;
    array(output, "radius", 1, each().map(|k| bodies.radius.of(k)))?;
    array(output, "mass", 1, each().map(|k| bodies.mass.of(k)))?;
    array(output, "v", 3, vectors(&|k| bodies.velocity_of(k).to_array()))?;
    array(output, "omega", 3, vectors(&|k| bodies.spin_of(k).to_array()))?;
    let orientation = each().flat_map(|k| {
        let [w, x, y, z] = quaternion_of(bodies, k);
        [x, y, z, w]
    });
    array(output, "Orientation", 4, orientation)?;
    if let Some(images) = frame.images {
        array(output, "image", 3, each().flat_map(|k| images.of(k).each(i64::from)))?;
    }
    writeln!(output, "    </PointData>\n    </Piece>\n  </PolyData>\n</VTKFile>")?;
    output.flush()
}

/// A number in an array of VTK.
pub(super) trait Element {
    /// What VTK calls its type.
    fn name() -> &'static str;
    /// Adds its bytes, the least significant first.
    fn push(self, bytes: &mut Vec<u8>);
}

impl Element for i64 {
    fn name() -> &'static str {
        "Int64"
    }

    fn push(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }
}

impl<T: Real> Element for T {
    fn name() -> &'static str {
        if T::NAME == f32::NAME { "Float32" } else { "Float64" }
    }

    fn push(self, bytes: &mut Vec<u8>) {
        self.write_bits(bytes);
    }
}

fn array<W: io::Write, E: Element>(
    output: &mut W,
    name: &str,
    components: usize,
    values: impl Iterator<Item = E>,
) -> io::Result<()> {
    let mut bytes = vec![0; 8];
    for value in values {
        value.push(&mut bytes);
    }
    // The length stands before the data, in one text with it.
    let length = (bytes.len() as u64 - 8).to_le_bytes();
    bytes[..8].copy_from_slice(&length);
    let kind = E::name();
    write!(
        output,
        "      <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
         format=\"binary\">"
    )?;
    output.write_all(STANDARD.encode(&bytes).as_bytes())?;
    writeln!(output, "</DataArray>")
}
