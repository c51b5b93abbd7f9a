//! Items in columns, tested many at once.

use bytemuck::Zeroable;
use nearmiss_kernels::exec::{PairTest, WARP};

/// Items that are tested together: two vectors of f32 on most machines, or one.
const WIDTH: usize = 16;
/// Strips of items that the lanes of a warp fill.
const STRIPS: usize = WARP as usize / WIDTH;
/// Words of an item at most.
const MOST: usize = 16;

/// At most [`WARP`] items, by columns: word `k` of item `i` is `strips[i / WIDTH][k][i % WIDTH]`.
#[derive(Default)]
pub struct Columns {
    strips: [Strip; STRIPS],
    len: usize,
}

impl Columns {
    /// Forgets all items.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends an item.
    #[inline(always)]
    pub fn push<M: PairTest>(&mut self, item: &M::Item) {
        const { assert!(size_of::<M::Item>() <= 4 * MOST && size_of::<M::Item>().is_multiple_of(4)) };
        let words: &[u32] = bytemuck::cast_slice(std::slice::from_ref(item));
        let (strip, place) = (self.len / WIDTH, self.len % WIDTH);
        for (column, word) in self.strips[strip].iter_mut().zip(words) {
            column[place] = *word;
        }
        self.len += 1;
    }

    /// Which of the items pass the test with each of the others: bit `i` for item `i`.
    #[inline(always)]
    pub fn test<M: PairTest>(&self, others: &[M::Item], passes: &mut [u32]) {
        strips::<M>(&self.strips[..self.len.div_ceil(WIDTH)], others, passes);
        // Behind the last item lies what is left of others.
        let all = ((1u64 << self.len) - 1) as u32;
        passes.iter_mut().for_each(|passes| *passes &= all);
    }
}

/// Items of a strip, by words.
type Strip = [[u32; WIDTH]; MOST];

/// A function of items by columns, compiled for several machines.
macro_rules! for_each_machine {
    ($name:ident, $wide:ident, $widest:ident, $all:ident, ($($arg:ident: $Arg:ty),*) $(-> $Out:ty)?) => {
        #[inline(always)]
        pub fn $name<M: PairTest>($($arg: $Arg),*) $(-> $Out)? {
            #[cfg(target_arch = "x86_64")]
            if has_avx512() {
                // SAFETY: the machine has the features that the function is compiled for.
                return unsafe { $widest::<M>($($arg),*) };
            }
            #[cfg(target_arch = "x86_64")]
            if is_x86_feature_detected!("avx2") {
                // SAFETY: as above.
                return unsafe { $wide::<M>($($arg),*) };
            }
            $all::<M>($($arg),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $wide<M: PairTest>($($arg: $Arg),*) $(-> $Out)? {
            $all::<M>($($arg),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
        fn $widest<M: PairTest>($($arg: $Arg),*) $(-> $Out)? {
            $all::<M>($($arg),*)
        }
    };
}

for_each_machine!(
    strips, strips_avx2, strips_avx512, strips_each,
    (strips: &[Strip], others: &[M::Item], passes: &mut [u32])
);
for_each_machine!(
    wide, wide_avx2, wide_avx512, wide_each,
    (columns: &[[u32; WARP as usize]], other: &M::Item) -> u32
);

/// Whether the machine has the vectors of 16 words that `*_avx512` functions are compiled for.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

#[inline(always)]
fn strips_each<M: PairTest>(strips: &[Strip], others: &[M::Item], passes: &mut [u32]) {
    for (other, passes) in others.iter().zip(passes) {
        *passes = 0;
        for (i, strip) in strips.iter().enumerate() {
            *passes |= each::<M, WIDTH>(strip, other) << (i * WIDTH);
        }
    }
}

/// Which lanes' items, by columns, pass the test with another.
#[inline(always)]
fn wide_each<M: PairTest>(columns: &[[u32; WARP as usize]], other: &M::Item) -> u32 {
    each::<M, { WARP as usize }>(columns, other)
}

/// The compiler vectorises the first loop.
#[inline(always)]
fn each<M: PairTest, const N: usize>(columns: &[[u32; N]], other: &M::Item) -> u32 {
    let mut passes = [0u32; N];
    // A number that the compiler knows, or there are no vectors.
    let columns = &columns[..size_of::<M::Item>() / size_of::<u32>()];
    for (place, passes) in passes.iter_mut().enumerate() {
        let mut item = M::Item::zeroed();
        let words: &mut [u32] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut item));
        for (word, column) in words.iter_mut().zip(columns) {
            *word = column[place];
        }
        *passes = u32::from(M::test(&item, other)) << place;
    }
    passes.iter().fold(0, |all, one| all | one)
}

#[cfg(test)]
mod tests {
    use super::{Columns, MOST, WIDTH, each, wide};
    use nearmiss_kernels::bv::{Aabb, Linear, Volume};
    use nearmiss_kernels::exec::{PairTest, WARP};

    /// The test of the walk.
    struct Overlap<V>(std::marker::PhantomData<V>);

    impl<V: Volume> PairTest for Overlap<V> {
        type Item = V;
        fn test(a: &V, b: &V) -> bool {
            a.may_overlap(b)
        }
    }

    /// Volumes made of small whole numbers, so that they touch, overlap and are apart.
    fn volume<V: Volume>(seed: u32) -> V {
        let mut volume = V::zeroed();
        let bytes = &mut bytemuck::bytes_of_mut(&mut volume)[..V::BYTES];
        for (k, word) in bytes.chunks_exact_mut(4).enumerate() {
            let low = (seed.wrapping_mul(2654435761) >> (k % 3 * 5)) % 7;
            let is_upper = k / 3 % 2 == 1;
            word.copy_from_slice(&((low + 2 * u32::from(is_upper)) as f32).to_ne_bytes());
        }
        volume
    }

    fn agrees<V: Volume>() {
        let mut met = 0;
        for count in 0..=WARP {
            let items: Vec<V> = (0..count).map(|i| volume(31 * count + i)).collect();
            let mut columns = Columns::default();
            items.iter().for_each(|item| columns.push::<Overlap<V>>(item));
            let others: Vec<V> = (0..40).map(|other| volume(1000 + other)).collect();
            let mut together = vec![0; others.len()];
            columns.test::<Overlap<V>>(&others, &mut together);
            let mut in_lanes = [[0; WARP as usize]; MOST];
            for (k, column) in in_lanes.iter_mut().enumerate() {
                *column = std::array::from_fn(|i| columns.strips[i / WIDTH][k][i % WIDTH]);
            }
            for (other, bits) in others.iter().zip(together) {
                let alone = items
                    .iter()
                    .enumerate()
                    .fold(0, |all, (i, item)| all | u32::from(item.may_overlap(other)) << i);
                assert_eq!(bits, alone, "{count} items");
                let whole = wide::<Overlap<V>>(&in_lanes, other);
                assert_eq!(whole & ((1u64 << count) - 1) as u32, alone, "{count} lanes");
                let plain = each::<Overlap<V>, WIDTH>(&columns.strips[0], other);
                let first = ((1u64 << (count as usize).min(WIDTH)) - 1) as u32;
                assert_eq!(plain & first, alone & first & 0xffff, "{count} items, by the plain loop");
                met += bits.count_ones();
            }
        }
        assert!(met > 1000 && met < 30_000, "{met} of the pairs meet");
        assert!(V::BYTES <= 4 * MOST);
    }

    #[test]
    fn many_at_once_are_as_one_by_one() {
        agrees::<Aabb>();
        agrees::<Linear>();
    }
}
