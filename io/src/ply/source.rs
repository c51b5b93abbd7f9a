//! The scalars of a PLY body: one reader for each type and encoding; none allocates.

use super::header::Encoding;

/// The scalar types of PLY.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// A scalar as read; every whole number of PLY fits an `i64`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Value {
    Int(i64),
    F32(f32),
    F64(f64),
}

impl Scalar {
    pub fn named(word: &str) -> Option<Scalar> {
        Some(match word {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    pub fn name(self) -> &'static str {
        match self {
            Scalar::I8 => "int8",
            Scalar::U8 => "uint8",
            Scalar::I16 => "int16",
            Scalar::U16 => "uint16",
            Scalar::I32 => "int32",
            Scalar::U32 => "uint32",
            Scalar::F32 => "float32",
            Scalar::F64 => "float64",
        }
    }

    /// Bytes in a binary body.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// Whether every value of the type is a float.
    pub fn fits_f32(self) -> bool {
        !matches!(self, Scalar::I32 | Scalar::U32 | Scalar::F64)
    }

    /// The value of an ascii token, rounded to the declared type as the format demands; `None` if
    /// it is not one.
    fn parse(self, token: &[u8]) -> Option<Value> {
        let text = std::str::from_utf8(token).ok()?;
        let int = |low: i64, high: i64| {
            text.parse().ok().filter(|i: &i64| (low..=high).contains(i)).map(Value::Int)
        };
        match self {
            Scalar::I8 => int(i8::MIN.into(), i8::MAX.into()),
            Scalar::U8 => int(0, u8::MAX.into()),
            Scalar::I16 => int(i16::MIN.into(), i16::MAX.into()),
            Scalar::U16 => int(0, u16::MAX.into()),
            Scalar::I32 => int(i32::MIN.into(), i32::MAX.into()),
            Scalar::U32 => int(0, u32::MAX.into()),
            Scalar::F32 => text.parse().ok().map(Value::F32),
            Scalar::F64 => text.parse().ok().map(Value::F64),
        }
    }

    /// The value of exactly `size()` bytes in little-endian order.
    fn decode(self, b: [u8; 8]) -> Value {
        match self {
            Scalar::I8 => Value::Int(i8::from_le_bytes([b[0]]).into()),
            Scalar::U8 => Value::Int(b[0].into()),
            Scalar::I16 => Value::Int(i16::from_le_bytes([b[0], b[1]]).into()),
            Scalar::U16 => Value::Int(u16::from_le_bytes([b[0], b[1]]).into()),
            Scalar::I32 => Value::Int(i32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()),
            Scalar::U32 => Value::Int(u32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()),
            Scalar::F32 => Value::F32(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Scalar::F64 => Value::F64(f64::from_le_bytes(b)),
        }
    }
}

/// Reasons why a scalar could not be read.
pub(super) enum Failure<'a> {
    /// The file ends.
    End,
    /// The line ends (ascii).
    LineEnd,
    /// The token is not of the type (ascii).
    Token(&'a [u8]),
}

/// The body of the file, from front to back.
pub(super) struct Source<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl<'a> Source<'a> {
    pub fn new(rest: &'a [u8], encoding: Encoding) -> Source<'a> {
        Source { rest, encoding }
    }

    /// Bytes not yet read.
    pub fn left(&self) -> usize {
        self.rest.len()
    }

    /// Minimum bytes of a scalar: in ascii a digit and a separator.
    pub fn least(&self, scalar: Scalar) -> u64 {
        if self.encoding == Encoding::Ascii { 2 } else { scalar.size() as u64 }
    }

    /// Whether `need` bytes can be left; the last token of an ascii file needs no line end.
    pub fn holds(&self, need: u128) -> bool {
        let spare = u128::from(self.encoding == Encoding::Ascii);
        need <= self.rest.len() as u128 + spare
    }

    /// The next scalar.
    pub fn next(&mut self, scalar: Scalar) -> Result<Value, Failure<'a>> {
        if self.encoding == Encoding::Ascii {
            let token = self.token();
            return match token {
                [] if self.rest.is_empty() => Err(Failure::End),
                [] => Err(Failure::LineEnd),
                _ => scalar.parse(token).ok_or(Failure::Token(token)),
            };
        }
        let (now, rest) = self.rest.split_at_checked(scalar.size()).ok_or(Failure::End)?;
        self.rest = rest;
        let mut bytes = [0; 8];
        bytes[..now.len()].copy_from_slice(now);
        if self.encoding == Encoding::Big {
            bytes[..now.len()].reverse();
        }
        Ok(scalar.decode(bytes))
    }

    /// Moves to the next line that is not empty (ascii).
    pub fn begin_entry(&mut self) {
        if self.encoding == Encoding::Ascii {
            self.rest = self.rest.trim_ascii_start();
        }
    }

    /// The rest of the line: empty, or one token too many (ascii).
    pub fn end_entry(&mut self) -> &'a [u8] {
        if self.encoding == Encoding::Ascii { self.token() } else { &[] }
    }

    /// The next token on this line; empty at its end.
    fn token(&mut self) -> &'a [u8] {
        let blank = |b: &u8| b.is_ascii_whitespace() && !is_line_end(*b);
        let start = self.rest.iter().position(|b| !blank(b)).unwrap_or(self.rest.len());
        let rest = &self.rest[start..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (token, rest) = rest.split_at(length);
        self.rest = rest;
        token
    }
}

fn is_line_end(b: u8) -> bool {
    matches!(b, b'\n' | b'\r')
}
