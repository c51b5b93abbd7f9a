//! Bytes as coordinates that are likely to be hard: few different ones, nearly equal ones, powers
//! of two, the smallest and the largest.

/// Reads bytes; past the end all are zero.
pub struct Bytes<'a> {
    left: &'a [u8],
    /// Coordinates read so far; later ones may equal or nearly equal them.
    seen: Vec<f64>,
    /// Coordinates are rounded to f32.
    single: bool,
    /// Construction of most coordinates of this input.
    style: u8,
    /// Stretch of the axes, as powers of two.
    stretch: [i32; 3],
}

/// First bytes from here on stretch the axes, by their two next bits: huge, mixed-scale,
/// axes-extreme, tiny.
pub const DIRECTED: u8 = 0xc0;

impl<'a> Bytes<'a> {
    /// Reads the first byte: the construction of coordinates, whether they are in f32, and whether
    /// axes are stretched.
    pub fn new(bytes: &'a [u8]) -> Bytes<'a> {
        let mut new = Bytes { left: bytes, seen: Vec::new(), single: false, style: 0, stretch: [0; 3] };
        let first = new.byte();
        new.single = first & 1 == 1;
        new.style = first >> 1;
        if first >= DIRECTED {
            new.stretch = new.stretched(first >> 4 & 3);
        }
        new
    }

    /// The stretch of the axes in a directed family.
    fn stretched(&mut self, family: u8) -> [i32; 3] {
        let (least, most) = if self.single { (-149, 60) } else { (-1074, 480) };
        let by = [0; 3].map(|_| i32::from(self.byte()));
        let turn = by[0] as usize % 3;
        let mut all = match family {
            // For coordinates that are mostly small.
            0 => [most - 5 - by[0] % 16; 3],
            1 => by.map(|by| most * (by - 128) / 256),
            2 => {
                let one = least / 2 - 5 + by[1] % 11;
                [most - 5 - by[0] % 16, one, least + by[2] % 8 - one]
            }
            _ => [least + by[0] % 32; 3],
        };
        all.rotate_left(turn);
        all
    }

    /// `x 2^e` in the input's precision; `x` if that is not finite.
    fn stretch(&self, x: f64, e: i32) -> f64 {
        let y = x * 2f64.powi(e / 2) * 2f64.powi(e - e / 2);
        let y = if self.single { f64::from(y as f32) } else { y };
        if y.is_finite() { y } else { x }
    }

    /// Whether all coordinates are exact in f32.
    pub fn is_single(&self) -> bool {
        self.single
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.left.split_first() else { return 0 };
        self.left = rest;
        *first
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.byte() as usize % n
    }

    /// Eight bytes.
    fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// A finite coordinate.
    pub fn coordinate(&mut self) -> f64 {
        let byte = self.byte();
        let small = f64::from(byte as i8 >> 3);
        // Five of eight are made in the input's style.
        let x = match if byte & 7 < 5 { self.style % 8 } else { byte & 7 } {
            0 => f64::from(byte as i8 >> 6),
            1 => small,
            2 => small / 3.0,
            3 => 1.0 + small * if self.single { f64::from(f32::EPSILON) } else { f64::EPSILON },
            4 => 2f64.powi(i32::from(byte as i8 >> 2)) * if byte & 1 == 0 { 1.0 } else { -1.0 },
            5 => self.again(byte, small),
            6 => small * if self.single { f64::from(f32::from_bits(1)) } else { f64::from_bits(1) },
            _ => self.any(small),
        };
        let x = if self.single { f64::from(x as f32) } else { x };
        let x = if x.is_finite() { x } else { small };
        self.seen.push(x);
        x
    }

    /// An earlier coordinate, or its neighbour, or its negative.
    fn again(&mut self, byte: u8, small: f64) -> f64 {
        let Some(from) = self.seen.len().checked_sub(1) else { return small };
        let x = self.seen[from - usize::from(byte >> 5) % self.seen.len()];
        match byte >> 3 & 3 {
            0 => x,
            1 if self.single => f64::from((x as f32).next_up()),
            1 => x.next_up(),
            2 if self.single => f64::from((x as f32).next_down()),
            2 => x.next_down(),
            _ => -x,
        }
    }

    /// Any number, or a distant one.
    fn any(&mut self, small: f64) -> f64 {
        match self.below(4) {
            0 if self.single => f64::from(f32::from_bits(self.word() as u32)),
            0 => f64::from_bits(self.word()),
            1 => f64::from(1 << 20) + small,
            2 => small * if self.single { 2f64.powi(55) } else { 2f64.powi(470) },
            _ => self.word() as i64 as f64 * 2f64.powi(-60),
        }
    }

    /// A point.
    pub fn point(&mut self) -> [f64; 3] {
        let x = [0; 3].map(|_| self.coordinate());
        let by = self.stretch;
        [0, 1, 2].map(|k| self.stretch(x[k], by[k]))
    }

    /// A point; half of the time one of `given`.
    pub fn point_or(&mut self, given: &[[f64; 3]]) -> [f64; 3] {
        match self.byte() {
            byte if byte & 1 == 1 && !given.is_empty() => given[usize::from(byte >> 1) % given.len()],
            _ => self.point(),
        }
    }
}

/// The largest coordinate that a mesh may have, in its precision.
pub fn largest(single: bool) -> f64 {
    2f64.powi(if single { 60 } else { 480 })
}
