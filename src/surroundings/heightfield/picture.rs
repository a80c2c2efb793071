//! Picture: heights as the grey levels of a PNG file.

use std::io::Cursor;

use png::{ColorType, Decoder, Transformations};

use crate::surroundings::mesh::MeshError;

/// How many bytes a byte of a compressed file can stand for.
const MOST_COMPRESSED: u64 = 1032;

/// The grey levels of a picture, 0 for black and 1 for white, row by row from its lower left
/// pixel, and how many a row has.
pub(super) fn read(bytes: &[u8]) -> Result<(usize, Vec<f64>), MeshError> {
    let refused = |error: png::DecodingError| MeshError::Picture(error.to_string());
    let mut decoder = Decoder::new(Cursor::new(bytes));
    // All levels as bytes, in the colours that the picture says.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(refused)?;
    let (width, height) = reader.info().size();
    let length = reader.output_buffer_size();
    if length as u64 > MOST_COMPRESSED * bytes.len() as u64 {
        let length = bytes.len();
        let problem = format!(
            "it says that it has {width} × {height} pixels, which its {length} bytes cannot hold"
        );
        return Err(MeshError::Picture(problem));
    }
    let mut pixels = vec![0; length];
    let frame = reader.next_frame(&mut pixels).map_err(refused)?;
    reader.finish().map_err(refused)?;
    let bytes_each = frame.bit_depth as usize / 8;
    let level = move |sample: &[u8]| match *sample {
        [high, low] => f64::from(u16::from_be_bytes([high, low])) / f64::from(u16::MAX),
        _ => f64::from(sample[0]) / f64::from(u8::MAX),
    };
    let samples = frame.color_type.samples();
    let mut levels = Vec::with_capacity(width as usize * height as usize);
    for (row, line) in pixels.chunks_exact(frame.line_size).enumerate().rev() {
        for (column, pixel) in line.chunks_exact(samples * bytes_each).enumerate() {
            let (colours, opacity) = match frame.color_type {
                ColorType::GrayscaleAlpha | ColorType::Rgba => {
                    pixel.split_at((samples - 1) * bytes_each)
                }
                _ => (pixel, &[u8::MAX; 2][..bytes_each]),
            };
            let (grey, others) = colours.split_at(bytes_each);
            let is_grey = others.chunks_exact(bytes_each).all(|other| other == grey);
            if !is_grey || opacity.iter().any(|&byte| byte != u8::MAX) {
                let problem = format!(
                    "the pixel {column} from the left and {row} from the top, from 0, is no shade \
                     of grey, or not opaque; heights are levels of grey"
                );
                return Err(MeshError::Picture(problem));
            }
            levels.push(level(grey));
        }
    }
    Ok((width as usize, levels))
}
