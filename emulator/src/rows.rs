//! Functions of rows, applied to many rows at once.

use bytemuck::Zeroable;
use nearmiss_kernels::exec::RowMap;

/// Rows that are mapped together: two vectors of f32 on most machines, or one.
pub const WIDTH: usize = 16;

/// Rows by columns, [`WIDTH`] at a time: number `k` of row `i` is
/// `columns[i / WIDTH * NUMBERS + k][i % WIDTH]`.
pub struct Rows<'a, M: RowMap> {
    columns: &'a mut [[M::Number; WIDTH]],
}

impl<'a, M: RowMap> Rows<'a, M> {
    /// Numbers of a row.
    const NUMBERS: usize = size_of::<M::Row>() / size_of::<M::Number>();

    /// `len` rows with any numbers, in memory of earlier rows.
    pub fn new(len: usize, memory: &'a mut Vec<u64>) -> Self {
        let columns = len.div_ceil(WIDTH) * Self::NUMBERS;
        let words = columns * size_of::<[M::Number; WIDTH]>() / size_of::<u64>();
        if memory.len() < words {
            memory.resize(words, 0);
        }
        Rows { columns: bytemuck::cast_slice_mut(&mut memory[..words]) }
    }

    /// Sets a row.
    #[inline(always)]
    pub fn set(&mut self, i: usize, row: &M::Row) {
        let columns = &mut self.columns[i / WIDTH * Self::NUMBERS..][..Self::NUMBERS];
        let numbers: &[M::Number] = bytemuck::cast_slice(std::slice::from_ref(row));
        for (column, number) in columns.iter_mut().zip(numbers) {
            column[i % WIDTH] = *number;
        }
    }

    /// Zeroes what is behind the first rows in their strip: it is computed with, and its numbers are of
    /// an earlier call.
    pub fn zero_behind(&mut self, count: usize) {
        let lane = count % WIDTH;
        if lane > 0 {
            let columns = &mut self.columns[count / WIDTH * Self::NUMBERS..][..Self::NUMBERS];
            columns.iter_mut().for_each(|column| column[lane..].fill(M::Number::zeroed()));
        }
    }

    /// A row.
    pub fn get(&self, i: usize) -> M::Row {
        row::<M>(&self.columns[i / WIDTH * Self::NUMBERS..], i % WIDTH)
    }

    /// The results of the first rows by vector code, or [`OPEN`](nearmiss_kernels::exec::OPEN): as
    /// many strips as there are results.
    pub fn at_once(&self, map: &M, results: &mut [[u32; WIDTH]]) {
        at_once(map, self.columns, results);
    }
}

fn at_once<M: RowMap>(map: &M, columns: &[[M::Number; WIDTH]], results: &mut [[u32; WIDTH]]) {
    #[cfg(target_arch = "x86_64")]
    if crate::columns::has_avx512() {
        // SAFETY: the machine has the features that the function is compiled for.
        return unsafe { at_once_avx512(map, columns, results) };
    }
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has the features that the function is compiled for.
        return unsafe { at_once_avx2(map, columns, results) };
    }
    each(map, columns, results);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn at_once_avx2<M: RowMap>(map: &M, columns: &[[M::Number; WIDTH]], results: &mut [[u32; WIDTH]]) {
    each(map, columns, results);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn at_once_avx512<M: RowMap>(map: &M, columns: &[[M::Number; WIDTH]], results: &mut [[u32; WIDTH]]) {
    each(map, columns, results);
}

/// The compiler vectorises the inner loop.
#[inline(always)]
fn each<M: RowMap>(map: &M, columns: &[[M::Number; WIDTH]], results: &mut [[u32; WIDTH]]) {
    for (columns, results) in columns.chunks_exact(Rows::<M>::NUMBERS).zip(results) {
        for (place, result) in results.iter_mut().enumerate() {
            *result = map.at_once(row::<M>(columns, place));
        }
        if M::HAS_SINGLES {
            singles(map, columns, results);
        }
    }
}

/// Maps rows whose numbers are all f32, in vectors if there are several.
#[inline(always)]
fn singles<M: RowMap>(map: &M, columns: &[[M::Number; WIDTH]], results: &mut [u32; WIDTH]) {
    let mut are_single = [false; WIDTH];
    for (place, is_single) in are_single.iter_mut().enumerate() {
        *is_single = map.is_single(&row::<M>(columns, place));
    }
    if are_single == [false; WIDTH] {
        return;
    }
    let mut mapped = [0; WIDTH];
    for (place, result) in mapped.iter_mut().enumerate() {
        *result = map.single_at_once(row::<M>(columns, place));
    }
    for place in 0..WIDTH {
        results[place] = if are_single[place] { mapped[place] } else { results[place] };
    }
}

/// A row, from its columns.
#[inline(always)]
fn row<M: RowMap>(columns: &[[M::Number; WIDTH]], place: usize) -> M::Row {
    let mut row = M::Row::zeroed();
    let numbers: &mut [M::Number] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut row));
    for k in 0..Rows::<M>::NUMBERS {
        numbers[k] = columns[k][place];
    }
    row
}

#[cfg(test)]
mod tests {
    use super::{Rows, WIDTH, each};
    use nearmiss_kernels::exec::RowMap;

    /// A map of four numbers with comparisons, a division and a choice, as in kernels' maps.
    struct Mixed;

    impl RowMap for Mixed {
        type Number = f32;
        type Row = [[f32; 2]; 2];
        #[inline(always)]
        fn at_once(&self, [[a, b], [c, d]]: [[f32; 2]; 2]) -> u32 {
            let q = a / (a.abs() + b.abs());
            if q > c { (q - d).to_bits() } else { (a * b - c * d).to_bits() }
        }
    }

    /// Numbers of all kinds, in rows that do not fill the last strip.
    fn rows() -> Vec<[[f32; 2]; 2]> {
        let kinds =
            [0.0, -0.0, 1.0, -3.5, 1e-42, -1e38, f32::MIN_POSITIVE, f32::INFINITY, f32::NEG_INFINITY, 0.1];
        let pick = |i: usize, k: usize| kinds[(i * (2 * k + 3) + i / 7 + k) % kinds.len()];
        (0..5 * WIDTH + 3).map(|i| [[pick(i, 0), pick(i, 1)], [pick(i, 2), pick(i, 3)]]).collect()
    }

    /// One bit pattern for every NaN: results may have any.
    fn canonical(bits: u32) -> u32 {
        if f32::from_bits(bits).is_nan() { f32::NAN.to_bits() } else { bits }
    }

    /// The bits of a number, and one: too much for a NaN of all ones.
    struct Next;

    impl RowMap for Next {
        type Number = f32;
        type Row = [f32; 1];
        #[inline(always)]
        fn at_once(&self, [a]: [f32; 1]) -> u32 {
            a.to_bits() + 1
        }
    }

    #[test]
    fn numbers_of_earlier_rows_are_not_computed_with() {
        for count in [1, WIDTH - 1, WIDTH, WIDTH + 3] {
            let mut memory = vec![u64::MAX; 4 * WIDTH];
            let mut columns = Rows::<Next>::new(2 * WIDTH, &mut memory);
            (0..count).for_each(|i| columns.set(i, &[i as f32]));
            columns.zero_behind(count);
            let mut results = vec![[0; WIDTH]; count.div_ceil(WIDTH)];
            columns.at_once(&Next, &mut results);
            let expected = (0..count).map(|i| (i as f32).to_bits() + 1);
            assert!(expected.eq(results.as_flattened()[..count].iter().copied()), "{count}");
        }
    }

    #[test]
    fn vectors_give_what_each_row_gives_by_itself() {
        let rows = rows();
        let mut memory = Vec::new();
        let mut columns = Rows::<Mixed>::new(rows.len(), &mut memory);
        rows.iter().enumerate().for_each(|(i, row)| columns.set(i, row));
        let mut together = vec![[0; WIDTH]; columns.columns.len() / Rows::<Mixed>::NUMBERS];
        columns.at_once(&Mixed, &mut together);
        let together = together.as_flattened();
        let mut plain = vec![[0; WIDTH]; columns.columns.len() / Rows::<Mixed>::NUMBERS];
        each(&Mixed, columns.columns, &mut plain);
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(columns.get(i).map(|x| x.map(f32::to_bits)), row.map(|x| x.map(f32::to_bits)));
            let alone = canonical(Mixed.apply(*row));
            assert_eq!(canonical(together[i]), alone, "row {i}, {row:?}");
            assert_eq!(canonical(plain.as_flattened()[i]), alone, "row {i}, {row:?}, by the plain loop");
        }
    }
}
