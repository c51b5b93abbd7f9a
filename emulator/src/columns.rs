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

    /// Which of the items pass the test with another: bit `i` for item `i`.
    #[inline(always)]
    pub fn test<M: PairTest>(&self, other: &M::Item) -> u32 {
        // Behind the last one lies what is left of others.
        strips::<M>(&self.strips[..self.len.div_ceil(WIDTH)], other) & ((1u64 << self.len) - 1) as u32
    }
}

/// Items of a strip, by words.
type Strip = [[u32; WIDTH]; MOST];

#[inline(always)]
fn strips<M: PairTest>(strips: &[Strip], other: &M::Item) -> u32 {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has the features that the function is compiled for.
        return unsafe { strips_avx2::<M>(strips, other) };
    }
    all::<M>(strips, other)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn strips_avx2<M: PairTest>(strips: &[Strip], other: &M::Item) -> u32 {
    all::<M>(strips, other)
}

#[inline(always)]
fn all<M: PairTest>(strips: &[Strip], other: &M::Item) -> u32 {
    let mut passes = 0;
    for (i, strip) in strips.iter().enumerate() {
        passes |= each::<M>(strip, other) << (i * WIDTH);
    }
    passes
}

/// The compiler vectorises the first loop.
#[inline(always)]
fn each<M: PairTest>(strip: &Strip, other: &M::Item) -> u32 {
    let mut passes = [0u32; WIDTH];
    for (place, passes) in passes.iter_mut().enumerate() {
        let mut item = M::Item::zeroed();
        let words: &mut [u32] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut item));
        for (word, column) in words.iter_mut().zip(strip) {
            *word = column[place];
        }
        *passes = u32::from(M::test(&item, other)) << place;
    }
    passes.iter().fold(0, |all, one| all | one)
}

#[cfg(test)]
mod tests {
    use super::{Columns, MOST, WIDTH, each};
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
            for other in 0..40 {
                let other = volume(1000 + other);
                let bits = columns.test::<Overlap<V>>(&other);
                let alone = items
                    .iter()
                    .enumerate()
                    .fold(0, |all, (i, item)| all | u32::from(item.may_overlap(&other)) << i);
                assert_eq!(bits, alone, "{count} items");
                let plain = each::<Overlap<V>>(&columns.strips[0], &other);
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
