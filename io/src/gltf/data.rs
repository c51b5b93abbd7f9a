//! The numbers of accessors, read within the bounds of their buffers.

use super::Others;
use crate::problems::wrong;
use crate::shown::shown;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::Source;
use ::gltf::{Accessor, Buffer, Gltf};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nearmiss::mesh::Problem;
use std::collections::HashMap;

/// The buffers of a file; those that are elsewhere are read when they are used.
pub(super) struct Data<'a> {
    file: &'a Gltf,
    others: Others<'a>,
    read: HashMap<usize, Vec<u8>>,
}

impl<'a> Data<'a> {
    pub fn new(file: &'a Gltf, others: Others<'a>) -> Data<'a> {
        Data { file, others, read: HashMap::new() }
    }

    /// The points of an accessor of floats.
    pub fn points(&mut self, accessor: &Accessor<'_>, called: &str) -> Result<Vec<[f64; 3]>, Problem> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(unread(called, "positions that are no floats"));
        }
        self.items(accessor, 12, called, |item| {
            [0, 4, 8]
                .map(|at| f64::from(f32::from_le_bytes([item[at], item[at + 1], item[at + 2], item[at + 3]])))
        })
    }

    /// The indices of an accessor.
    pub fn indices(&mut self, accessor: &Accessor<'_>, called: &str) -> Result<Vec<u32>, Problem> {
        let size = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => 1,
            (DataType::U16, Dimensions::Scalar) => 2,
            (DataType::U32, Dimensions::Scalar) => 4,
            _ => return Err(unread(called, "indices that are no whole numbers")),
        };
        self.items(accessor, size, called, |item| {
            item.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
        })
    }

    /// The items of an accessor, each of so many bytes.
    fn items<T>(
        &mut self,
        accessor: &Accessor<'_>,
        size: usize,
        called: &str,
        each: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, Problem> {
        if accessor.sparse().is_some() {
            return Err(unread(called, "sparse numbers"));
        }
        let Some(view) = accessor.view() else { return Err(unread(called, "numbers without a buffer")) };
        let bytes = self.buffer(&view.buffer())?;
        let within = view.offset().checked_add(view.length()).and_then(|end| bytes.get(view.offset()..end));
        let stride = view.stride().unwrap_or(size);
        let count = accessor.count();
        let need = count.checked_sub(1).map_or(Some(0), |last| {
            last.checked_mul(stride)?.checked_add(size)?.checked_add(accessor.offset())
        });
        let bytes = within.filter(|bytes| stride >= size && need.is_some_and(|need| need <= bytes.len()));
        let Some(bytes) = bytes else {
            let what = format!("{called}: accessor {} has {count} items beyond its buffer", accessor.index());
            return Err(wrong(what, "copy the file again, or export it again"));
        };
        let at = |item: usize| accessor.offset() + item * stride;
        Ok((0..count).map(|item| each(&bytes[at(item)..at(item) + size])).collect())
    }

    /// The bytes of a buffer: in the file, in its text, or in another file.
    fn buffer(&mut self, buffer: &Buffer<'_>) -> Result<&[u8], Problem> {
        match buffer.source() {
            Source::Bin => self.file.blob.as_deref().ok_or_else(|| {
                wrong(format!("buffer {} is not in the file", buffer.index()), "copy the file again")
            }),
            Source::Uri(uri) => {
                if !self.read.contains_key(&buffer.index()) {
                    let bytes = match uri.strip_prefix("data:").and_then(|rest| rest.split_once(',')) {
                        Some((_, text)) => STANDARD.decode(text).map_err(|e| {
                            wrong(format!("buffer {} is no base64: {e}", buffer.index()), "export it again")
                        })?,
                        None => (self.others)(&path(uri)?)?,
                    };
                    self.read.insert(buffer.index(), bytes);
                }
                Ok(&self.read[&buffer.index()])
            }
        }
    }
}

fn unread(called: &str, what: &str) -> Problem {
    wrong(format!("{called}: has {what}, which are not read"), "export it without compression")
}

/// The path that a reference is: relative, with its escapes resolved.
fn path(uri: &str) -> Result<String, Problem> {
    let refused = || {
        let what = format!("names the file {:?}, which is no path from it", shown(uri.as_bytes()));
        wrong(what, "put its buffers next to it, or export a .glb")
    };
    if uri.starts_with(['/', '\\']) || uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err(refused());
    }
    let (mut bytes, mut rest) = (Vec::with_capacity(uri.len()), uri.as_bytes());
    while let Some((&first, after)) = rest.split_first() {
        let escaped = (first == b'%').then(|| after.get(..2)).flatten();
        let escaped = escaped.and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        bytes.push(escaped.unwrap_or(first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).map_err(|_| refused())
}
