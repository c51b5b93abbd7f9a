//! Bytes of messages: numbers in lists, one after another.

use bytemuck::Pod;

/// A message that is written.
#[derive(Default)]
pub(crate) struct Writer(pub Vec<u8>);

impl Writer {
    /// Appends a list: the number of its entries, then the entries.
    pub fn put<T: Pod>(&mut self, list: &[T]) {
        self.0.extend_from_slice(&(list.len() as u64).to_ne_bytes());
        self.0.extend_from_slice(bytemuck::cast_slice(list));
    }
}

/// A message that is read. Both ends are the same program on machines of one kind, so numbers have
/// one layout.
pub(crate) struct Reader<'a>(pub &'a [u8]);

impl Reader<'_> {
    /// Takes the next list. A message that is too short gives zeros.
    pub fn take<T: Pod>(&mut self) -> Vec<T> {
        let mut count = [0; 8];
        self.fill(&mut count);
        let most = self.0.len() / size_of::<T>().max(1);
        let mut list = vec![T::zeroed(); most.min(u64::from_ne_bytes(count) as usize)];
        self.fill(bytemuck::cast_slice_mut(&mut list));
        list
    }

    fn fill(&mut self, to: &mut [u8]) {
        let (own, rest) = self.0.split_at(to.len().min(self.0.len()));
        to[..own.len()].copy_from_slice(own);
        self.0 = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_come_back_and_a_cut_message_ends() {
        let mut message = Writer::default();
        message.put(&[1.5f64, -0.0]);
        message.put::<u32>(&[]);
        message.put(&[[7u32, 8]]);
        let mut reader = Reader(&message.0);
        assert_eq!(
            reader.take::<f64>().iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
            [1.5f64.to_bits(), (-0.0f64).to_bits()]
        );
        assert!(reader.take::<u32>().is_empty());
        assert_eq!(reader.take::<[u32; 2]>(), [[7, 8]]);
        assert!(reader.0.is_empty() && reader.take::<u8>().is_empty());
        assert!(Reader(&message.0[..9]).take::<f64>().is_empty());
    }
}
