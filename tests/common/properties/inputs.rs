//! Inputs: bytes for the properties out of numbers, so that each can be made again, and
//! scene files with some of their text changed.

use crate::common::numbers::Random;

/// Values that stand in the place of others.
const VALUES: [&str; 40] = [
    "nan",
    "inf",
    "-inf",
    "0",
    "-0.0",
    "0.0",
    "1",
    "-1",
    "0.5",
    "2",
    "3.0",
    "0.1",
    "1e-3",
    "1e3",
    "1e308",
    "1e309",
    "1e154",
    "1e-154",
    "1e38",
    "1e-38",
    "3.5e38",
    "1e19",
    "1e-19",
    "1e10",
    "1e-10",
    "5e-324",
    "1e-45",
    "1e-300",
    "9007199254740993",
    "18446744073709551616",
    "-9223372036854775808",
    "1_0",
    "0x1F",
    "true",
    "\"x\"",
    "[]",
    "[0, 0]",
    "[1.0, 2.0]",
    "[0.0, 0.0, 1.0]",
    "1979-05-27",
];

/// Lines that can stand somewhere.
const LINES: [&str; 44] = [
    "precision = \"f32\"",
    "precision = \"f64\"",
    "engine = \"stepped\"",
    "engine = \"event-driven\"",
    "duration = 1.0",
    "gravity = [0.0, 0.0, -9.81]",
    "seed = 7",
    "encounters = \"surroundings\"",
    "encounters = \"none\"",
    "periodic = \"cube\"",
    "[periodic]",
    "lower = [0.0, 0.0, 0.0]",
    "upper = [4.0, 4.0, 4.0]",
    "[stepped]",
    "dt = 1e-3",
    "integrator = \"explicit-euler\"",
    "integrator = \"semi-implicit-euler\"",
    "impact = \"end-of-step\"",
    "orientation = \"each-step\"",
    "summation = \"compensated\"",
    "[surface]",
    "kind = \"rough\"",
    "[[surroundings]]",
    "shape = \"plane\"",
    "shape = \"box\"",
    "shape = \"sphere\"",
    "point = [0.0, 0.0, 0.0]",
    "normal = [0.0, 0.0, 1.0]",
    "inside = true",
    "center = [0.0, 0.0, 0.0]",
    "[[spheres]]",
    "position = [1.0, 1.0, 1.0]",
    "radius = 0.5",
    "radius = [0.1, 0.2]",
    "mass = 2.0",
    "density = 1.0",
    "inertia_factor = 0.4",
    "velocity = [1.0, 0.0, 0.0]",
    "spin = [0.0, 3.0, 0.0]",
    "count = 8",
    "arrangement = \"random\"",
    "arrangement = \"fcc\"",
    "number_density = 0.5",
    "temperature = 1.0",
];

/// What inputs are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Bytes of any kind.
    Bytes,
    /// Given files, bytes of which are changed.
    File,
    /// Given scene files, lines and values of which are changed.
    Text,
}

impl Kind {
    /// Of the property of a name.
    pub fn of(name: &str) -> Self {
        match name {
            "text" => Self::Text,
            "mesh" => Self::File,
            _ => Self::Bytes,
        }
    }
}

/// Inputs by their number, from some that there are.
pub struct Inputs {
    given: Vec<Vec<u8>>,
    kind: Kind,
}

impl Inputs {
    pub fn new(given: Vec<Vec<u8>>, kind: Kind) -> Self {
        Self { given, kind }
    }

    /// The input of a number: the same always.
    pub fn input(&self, number: u64) -> Vec<u8> {
        let mut random = Random(number);
        // Seeds that follow each other.
        random.0 = random.bits();
        match self.kind {
            Kind::Bytes => self.bytes(&mut random),
            Kind::File => self.file(&mut random),
            Kind::Text => self.text(&mut random),
        }
    }

    fn pick(&self, random: &mut Random) -> &[u8] {
        let given = self.given.as_slice();
        if given.is_empty() { &[] } else { &given[below(random, given.len())] }
    }

    /// Bytes of any kind, or given ones with a few changed.
    fn bytes(&self, random: &mut Random) -> Vec<u8> {
        let mut bytes = self.pick(random).to_vec();
        if below(random, 2) == 0 || bytes.is_empty() {
            let length = 16 + below(random, 240);
            return (0..length).map(|_| random.bits() as u8).collect();
        }
        for _ in 0..=below(random, 8) {
            let at = below(random, bytes.len());
            bytes[at] = random.bits() as u8;
        }
        bytes
    }

    /// A given file with some bytes put in the place of others, one cut off or repeated.
    fn file(&self, random: &mut Random) -> Vec<u8> {
        let mut bytes = self.pick(random).to_vec();
        for _ in 0..=below(random, 4) {
            if bytes.is_empty() {
                break;
            }
            let [at, other] = [(); 2].map(|()| below(random, bytes.len()));
            match below(random, 16) {
                0 => bytes.truncate(at),
                1 => drop(bytes.drain(at.min(other)..at.max(other))),
                2 => {
                    let more = bytes[at.min(other)..at.max(other)].to_vec();
                    bytes.splice(at..at, more);
                }
                3..7 => bytes[at] = random.bits() as u8,
                7..10 => bytes[at] ^= 1 << below(random, 8),
                _ => bytes[at] = bytes[other],
            }
        }
        bytes
    }

    /// A given text with a few of its lines and values changed.
    fn text(&self, random: &mut Random) -> Vec<u8> {
        let given = String::from_utf8_lossy(self.pick(random)).into_owned();
        let mut lines: Vec<String> = given.lines().map(str::to_owned).collect();
        for _ in 0..=below(random, 3) {
            self.change(&mut lines, random);
        }
        let mut bytes = lines.join("\n").into_bytes();
        if below(random, 16) == 0 && !bytes.is_empty() {
            let at = below(random, bytes.len());
            bytes[at] = random.bits() as u8;
        }
        bytes
    }

    fn change(&self, lines: &mut Vec<String>, random: &mut Random) {
        let at = below(random, lines.len() + 1);
        if at == lines.len() || below(random, 4) == 0 {
            lines.insert(at, LINES[below(random, LINES.len())].to_owned());
            return;
        }
        match below(random, 10) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[at].clone()),
            2 => {
                let other = below(random, lines.len());
                lines.swap(at, other);
            }
            3 => {
                let other = String::from_utf8_lossy(self.pick(random)).into_owned();
                lines.extend(other.lines().skip(below(random, 20)).take(12).map(str::to_owned));
            }
            _ => lines[at] = with_other_value(&lines[at], random),
        }
    }
}

/// A line with one of its values changed: a number, or all after the sign.
fn with_other_value(line: &str, random: &mut Random) -> String {
    let value = VALUES[below(random, VALUES.len())];
    let is_part = |c: char| c.is_ascii_digit() || "+-._eE".contains(c);
    let sign = line.find('=').map_or(0, |at| at + 1);
    let mut numbers = Vec::new();
    let mut rest = sign;
    while let Some(start) = line[rest..].find(|c: char| c.is_ascii_digit()).map(|at| rest + at) {
        let end = line[start..].find(|c| !is_part(c)).map_or(line.len(), |at| start + at);
        numbers.push(start..end);
        rest = end;
    }
    if numbers.is_empty() || below(random, 8) == 0 {
        return format!("{} {value}", &line[..sign]);
    }
    let number = numbers[below(random, numbers.len())].clone();
    format!("{}{value}{}", &line[..number.start], &line[number.end..])
}

fn below(random: &mut Random, count: usize) -> usize {
    (random.bits() % count as u64) as usize
}
