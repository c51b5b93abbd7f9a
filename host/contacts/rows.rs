//! Rows of an answer: the host's own, or those that a GPU has written in their final form.

use super::{Closest, Contact, Kind, NearPair, Status, TrianglePair, sort};
use crate::error::Error;
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::rows::{ContactRow, NearRow, PairRow, code};
use std::fmt;
use std::mem::offset_of;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// Rows of an answer, in canonical order. They are read as a slice.
///
/// Rows of a GPU's answer are in page-locked memory that the GPU has copied them into. Nothing
/// converts or copies them. When the last clone is dropped, later answers use the memory again. So
/// keep few answers, or [take](RowList::into_vec) their rows. A clone costs nothing: it shares the
/// memory. Rows that are changed are copied first.
#[derive(Clone)]
pub struct RowList<T> {
    /// The host's own; empty if the device has written the rows.
    own: Arc<Vec<T>>,
    /// Whole rows, as [`Row::Written`]. Only [`RowList::written`] makes them.
    kept: Option<Arc<Bytes>>,
}

/// Memory that the device has copied rows into.
pub(crate) type Bytes = dyn AsRef<[u8]> + Send + Sync;

/// Makes memory of so many bytes, which a function fills. `None` if that returns that it has not
/// filled all.
pub(crate) type Keep<'a> = &'a dyn Fn(usize, &dyn Fn(&mut [u8]) -> bool) -> Result<Option<Arc<Bytes>>, Error>;

/// A row that the device writes.
///
/// # Safety
/// Size, and offsets and types of all fields, are those of `Written`, except that a choice is a
/// byte there. A value whose choices are valid is a value of this type. Alignment is at most 8.
pub unsafe trait Row: Copy {
    /// The row, as the kernel writes it.
    type Written: Pod + Send + Sync;
    /// Whether all choices are valid.
    fn is_valid(written: &Self::Written) -> bool;
}

/// Checks that fields have the same offsets, and rows the same size.
macro_rules! same {
    ($row:ty, $written:ty: $($field:ident = $other:ident),+) => {
        const _: () = assert!(size_of::<$row>() == size_of::<$written>() && align_of::<$row>() <= 8);
        const _: () = assert!(true $(&& offset_of!($row, $field) == offset_of!($written, $other))+);
    };
}

same!(TrianglePair, PairRow: bodies = bodies, triangles = triangles);
same!(Contact, ContactRow: bodies = bodies, feature_a = features, toi = toi, toi_upper = toi_upper);
same!(Contact, ContactRow: kind = kind, status = status);
same!(NearPair, NearRow: bodies = bodies, feature_a = features, squared_distance = squared_distance);
same!(NearPair, NearRow: at = at, kind = kind, closest = closest);
const _: () = assert!(offset_of!(Contact, feature_b) == offset_of!(Contact, feature_a) + 4);
const _: () = assert!(offset_of!(NearPair, feature_b) == offset_of!(NearPair, feature_a) + 4);

/// Checks that a choice has the kernels' number.
macro_rules! numbered {
    ($($choice:expr, $code:ident;)+) => { $(const _: () = assert!($choice as u8 == code::$code);)+ };
}

numbered! {
    Kind::Vf, VERTEX_FACE;
    Kind::Ee, EDGE_EDGE;
    Kind::Ev, EDGE_VERTEX;
    Kind::Vv, VERTEX_VERTEX;
    Status::Unverified, UNVERIFIED;
    Status::Certified, CERTIFIED;
    Status::Undecided, UNDECIDED;
    Closest::VertexFace, NEAR_FACE;
    Closest::VertexEdge, NEAR_EDGE;
    Closest::VertexVertex, NEAR_VERTEX;
    Closest::EdgeEdge, NEAR_EDGES;
}

// SAFETY: as `same!` checks; there is no choice.
unsafe impl Row for TrianglePair {
    type Written = PairRow;
    fn is_valid(_: &PairRow) -> bool {
        true
    }
}

// SAFETY: as `same!` checks. Choices are of one byte (`repr(u8)`), and `numbered!` has them all.
unsafe impl Row for Contact {
    type Written = ContactRow;
    fn is_valid(written: &ContactRow) -> bool {
        written.kind <= code::VERTEX_VERTEX && written.status <= code::UNDECIDED
    }
}

// SAFETY: as above.
unsafe impl Row for NearPair {
    type Written = NearRow;
    fn is_valid(written: &NearRow) -> bool {
        written.kind <= code::VERTEX_VERTEX && written.closest <= code::NEAR_EDGES
    }
}

impl<T> RowList<T> {
    /// Returns the rows that `order_rank` wrote. Builds with debug assertions check every choice.
    ///
    /// # Safety
    /// The bytes are rows that [`Named::row`](nearmiss_kernels::abi::Named::row) made, or zeros;
    /// aligned to 8, and always the same.
    pub(crate) unsafe fn written(kept: Arc<Bytes>) -> RowList<T>
    where
        T: Row,
    {
        let valid = || cast_slice::<u8, T::Written>((*kept).as_ref()).iter().all(T::is_valid);
        debug_assert!(valid(), "the device wrote a row with an unknown choice");
        RowList { own: Arc::default(), kept: Some(kept) }
    }

    /// Returns the rows as the device has written them; `None` if there are rows of the host's own.
    fn as_written(&self) -> Option<&[T::Written]>
    where
        T: Row,
    {
        match &self.kept {
            Some(kept) => Some(cast_slice((**kept).as_ref())),
            None => self.own.is_empty().then_some(&[]),
        }
    }

    /// Merges sorted lists whose keys are distinct. Rows that devices have written are merged on all
    /// threads, into memory from `keep`.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if `looks` ends the work; those of `keep`.
    pub(crate) fn merged<K: Ord>(
        lists: &[&RowList<T>],
        key: impl Fn(&T) -> K + Sync,
        keep: Keep,
        looks: &Looks,
    ) -> Result<RowList<T>, Error>
    where
        T: Row + Send,
    {
        // Lists of the host's own rows are those of a CPU, whose frames take much longer.
        let Some(written) = lists.iter().map(|list| list.as_written()).collect::<Option<Vec<_>>>() else {
            let mut rows: Vec<T> = lists.iter().flat_map(|list| list.iter().copied()).collect();
            sort::sort_runs(&mut rows, key, looks);
            return if looks.ended() { Err(Error::Interrupted) } else { Ok(rows.into()) };
        };
        // SAFETY: a row of a list has valid choices, so it is a value of `T`, and aligned to 8.
        let key = |row: &T::Written| key(unsafe { &*(row as *const T::Written).cast() });
        let fill = |to: &mut [u8]| sort::merge(&written, &key, looks, cast_slice_mut(to));
        let bytes = written.iter().map(|list| size_of_val(*list)).sum();
        let kept = keep(bytes, &fill)?.ok_or(Error::Interrupted)?;
        // SAFETY: the rows are those of the lists.
        Ok(unsafe { RowList::written(kept) })
    }

    /// Returns the rows, to be changed; copies them if they are the device's or shared.
    pub fn to_mut(&mut self) -> &mut Vec<T>
    where
        T: Clone,
    {
        if self.kept.is_some() {
            *self = self.to_vec().into();
        }
        Arc::make_mut(&mut self.own)
    }

    /// Returns the rows as a vector; copies them if they are the device's or shared.
    pub fn into_vec(mut self) -> Vec<T>
    where
        T: Clone,
    {
        std::mem::take(self.to_mut())
    }
}

impl<T> Deref for RowList<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.kept {
            None => &self.own,
            Some(kept) => {
                let bytes = (**kept).as_ref();
                // SAFETY: `written` made it of whole rows: `T` is a `Row`, whose layout these bytes
                // have, aligned to 8. Each choice is valid by the promise of `written`. The bytes
                // stay as they are while they are kept.
                unsafe { std::slice::from_raw_parts(bytes.as_ptr().cast(), bytes.len() / size_of::<T>()) }
            }
        }
    }
}

impl<T: Clone> DerefMut for RowList<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.to_mut()
    }
}

impl<T> Default for RowList<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T> From<Vec<T>> for RowList<T> {
    fn from(rows: Vec<T>) -> Self {
        RowList { own: Arc::new(rows), kept: None }
    }
}

impl<T> FromIterator<T> for RowList<T> {
    fn from_iter<I: IntoIterator<Item = T>>(rows: I) -> Self {
        Vec::from_iter(rows).into()
    }
}

impl<T: Clone> IntoIterator for RowList<T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.into_vec().into_iter()
    }
}

impl<'a, T> IntoIterator for &'a RowList<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: PartialEq> PartialEq for RowList<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: PartialEq<U>, U> PartialEq<Vec<U>> for RowList<T> {
    fn eq(&self, other: &Vec<U>) -> bool {
        **self == **other
    }
}

impl<T: PartialEq<U>, U> PartialEq<[U]> for RowList<T> {
    fn eq(&self, other: &[U]) -> bool {
        **self == *other
    }
}

impl<T: PartialEq<U>, U, const N: usize> PartialEq<[U; N]> for RowList<T> {
    fn eq(&self, other: &[U; N]) -> bool {
        **self == *other
    }
}

impl<T: fmt::Debug> fmt::Debug for RowList<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        (**self).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::BodyId;
    use nearmiss_emulator::Interrupt;

    /// Rows in memory of the device.
    struct Written(Vec<ContactRow>);

    impl AsRef<[u8]> for Written {
        fn as_ref(&self) -> &[u8] {
            bytemuck::cast_slice(&self.0)
        }
    }

    /// Returns rows as the device would write them.
    fn written(rows: &[ContactRow]) -> RowList<Contact> {
        // SAFETY: these rows are such as a kernel writes, except the planted one, which the check
        // refuses. They have numbers of 8 bytes, and are never changed.
        unsafe { RowList::written(Arc::new(Written(rows.to_vec()))) }
    }

    fn row(kind: u8, status: u8) -> ContactRow {
        let (bodies, features) = ([1, 2], [3, 4]);
        ContactRow { bodies, features, toi: 0.25, toi_upper: 0.5, kind, status, pad: [0; 6] }
    }

    #[test]
    fn rows_of_the_device_are_those_of_the_host() {
        let rows = written(&[row(0, 1), row(1, 2)]);
        let contact = |kind, status| Contact {
            bodies: [BodyId(1), BodyId(2)],
            feature_a: 3,
            feature_b: 4,
            toi: 0.25,
            toi_upper: 0.5,
            kind,
            status,
        };
        let wanted = vec![contact(Kind::Vf, Status::Certified), contact(Kind::Ee, Status::Undecided)];
        assert_eq!(rows, wanted);
        let (mut changed, shared) = (rows.clone(), rows.clone());
        changed[0].toi = 0.0;
        changed.to_mut().pop();
        assert_eq!((changed.len(), changed[0].toi, shared.len()), (1, 0.0, 2));
        assert!(shared == rows && changed != rows && written(&[]).is_empty());
        assert_eq!(rows.into_vec(), wanted);
    }

    #[test]
    fn lists_become_one_whoever_has_written_them() {
        let keep: Keep = &|bytes, fill| {
            let mut rows = vec![row(0, 0); bytes / size_of::<ContactRow>()];
            Ok(fill(cast_slice_mut(&mut rows)).then(|| Arc::new(Written(rows)) as Arc<Bytes>))
        };
        let all: Vec<ContactRow> =
            (0..50_000).map(|n| ContactRow { features: [n / 3, n], ..row(0, 1) }).collect();
        let part = |of: usize| -> Vec<_> { all.iter().skip(of).step_by(3).copied().collect() };
        let by_device = [0, 1, 2].map(|of| written(&part(of)));
        let by_host = by_device.each_ref().map(|list| list.to_vec().into());
        let (none, whole): (RowList<Contact>, _) = (RowList::default(), written(&all));
        let [one, two, three] = &by_device;
        let [other, _, _] = &by_host;
        let merged =
            |lists: &[&RowList<Contact>], looks: &Looks| RowList::merged(lists, Contact::key, keep, looks);
        for lists in [vec![one, two, three], vec![three, &none, two, one], vec![other, two, three]] {
            let found = merged(&lists, &Looks::new(None)).expect("no interrupt");
            assert!(
                found == whole && found.kept.is_some() != std::ptr::eq(lists[0], other),
                "{}",
                lists.len()
            );
            let interrupt = Interrupt::new();
            interrupt.trigger();
            let ended = merged(&lists, &Looks::new(Some(&interrupt)));
            assert!(matches!(ended, Err(Error::Interrupted)));
        }
        assert!(merged(&[one, two], &Looks::new(None)).expect("no interrupt") != whole, "a list is missing");
        assert!(merged(&[&none, &none], &Looks::new(None)).expect("no interrupt").is_empty());
    }

    #[test]
    #[cfg(debug_assertions)]
    fn a_row_with_an_unknown_choice_is_noticed() {
        for row in [row(4, 0), row(0, 3)] {
            assert!(std::panic::catch_unwind(|| written(&[row])).is_err(), "{row:?}");
        }
    }
}
