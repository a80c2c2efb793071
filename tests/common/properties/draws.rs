//! Draws: choices and numbers out of bytes.

/// Where formulas and checks break.
const HOSTILE: [f64; 32] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    f64::EPSILON,
    f32::MAX as f64,
    f32::MIN_POSITIVE as f64,
    1e-45,
    f32::EPSILON as f64,
    1e154,
    1e-154,
    1e19,
    1e-19,
    1e38,
    1e-38,
    9_007_199_254_740_992.0,
    9_007_199_254_740_993e3,
    1e300,
    1e-300,
    16_777_217.0,
    4_294_967_296.0,
    1e10,
    1e-10,
    1e5,
    1.0 / 3.0,
    2.0 / 3.0,
    0.4,
    1e3,
];

/// Bytes, read in order; zeros where they end.
pub struct Draws<'a> {
    bytes: &'a [u8],
    /// How many of 256 numbers are hostile.
    hostile: u8,
}

impl<'a> Draws<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, hostile: 0 }
    }

    /// Chooses how hostile the numbers after this one are.
    pub fn choose_hostility(&mut self) {
        self.hostile = self.pick(&[0, 2, 8, 100]);
    }

    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        *first
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: u8) -> u8 {
        self.byte() % count
    }

    pub fn flag(&mut self) -> bool {
        self.below(2) == 1
    }

    pub fn pick<C: Copy>(&mut self, choices: &[C]) -> C {
        choices[usize::from(self.byte()) % choices.len()]
    }

    /// Between 0 and 1, of 2¹⁶ values.
    pub fn share(&mut self) -> f64 {
        f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / 65536.0
    }

    /// Between -1 and 1; 0 where the bytes have ended.
    pub fn signed(&mut self) -> f64 {
        f64::from(i16::from_le_bytes([self.byte(), self.byte()])) / 32768.0
    }

    pub fn direction(&mut self) -> [f64; 3] {
        [self.signed(), self.signed(), self.signed()]
    }

    /// Any number: a plain one, mostly, one of those that break things, or any bits.
    pub fn number(&mut self) -> f64 {
        if self.byte() >= self.hostile {
            return self.signed() * 4.0;
        }
        match self.below(4) {
            0 => self.pick(&HOSTILE),
            1 => -self.pick(&HOSTILE),
            2 => self.signed() * power_of_ten(self.signed()),
            _ => f64::from_bits(u64::from_le_bytes([(); 8].map(|()| self.byte()))),
        }
    }

    pub fn vector(&mut self) -> [f64; 3] {
        [self.number(), self.number(), self.number()]
    }

    /// A number above 0, mostly.
    pub fn figure(&mut self) -> f64 {
        let number = self.number();
        if number.abs() <= 4.0 { number.abs() / 8.0 + 1e-3 } else { number }
    }
}

/// Ten to a power between -300 and 300.
fn power_of_ten(share: f64) -> f64 {
    10_f64.powi((share * 300.0) as i32)
}
