//! Queries, each with a type of its own for the rows of its answer.

use super::{BodyDistances, BodyPairs, Continuous, Discrete, Distance, Earliest, Near, Query};
use crate::contacts::{
    BodyPair, Contact, FirstContact, NearPair, NearestTriangles, RowList, Rows, TrianglePair,
};

mod sealed {
    pub trait Sealed {}
}

/// A query with the type of its answer's rows: see [`Detector::query`](crate::Detector::query).
///
/// | query | rows |
/// | --- | --- |
/// | [`Discrete`] | [`RowList`]`<`[`TrianglePair`]`>` |
/// | [`Continuous`] | [`RowList`]`<`[`Contact`]`>` |
/// | [`Earliest`] | `Option<`[`FirstContact`]`>` |
/// | [`Near`] | [`RowList`]`<`[`NearPair`]`>` |
/// | [`Distance`] | `Option<`[`NearestTriangles`]`>` |
/// | [`BodyPairs`] | [`RowList`]`<`[`BodyPair`]`>` |
/// | [`BodyDistances`] | [`RowList`]`<`[`NearestTriangles`]`>` |
/// | [`Query`] | [`Rows`]: of any of these |
pub trait TypedQuery: Copy + Into<Query> + sealed::Sealed {
    /// Rows of its answer.
    type Rows;

    /// Converts the rows of any answer to it. `is_undecided` is whether an earliest time is
    /// undecided.
    #[doc(hidden)]
    fn rows(rows: Rows, is_undecided: bool) -> Self::Rows;
}

/// Makes the implementations. A line has a query, its rows and the conversion to them. Rows of
/// another kind become empty ones, which no query has.
macro_rules! rows {
    ($($query:ty => $rows:ty, $pattern:pat => $take:expr, $none:expr, $is_undecided:ident;)+) => {
        $(
            impl sealed::Sealed for $query {}

            impl TypedQuery for $query {
                type Rows = $rows;

                fn rows(rows: Rows, $is_undecided: bool) -> $rows {
                    if let $pattern = rows { $take } else { $none }
                }
            }
        )+
    };
}

rows! {
    Discrete => RowList<TrianglePair>, Rows::Pairs(pairs) => pairs, RowList::default(), _is_undecided;
    Continuous => RowList<Contact>, Rows::Contacts(contacts) => contacts, RowList::default(), _is_undecided;
    Earliest => Option<FirstContact>,
        Rows::Earliest(toi) => toi.map(|toi| FirstContact { toi, is_undecided }), None, is_undecided;
    Near => RowList<NearPair>, Rows::Near(pairs) => pairs, RowList::default(), _is_undecided;
    Distance => Option<NearestTriangles>, Rows::Distance(nearest) => nearest, None, _is_undecided;
    BodyPairs => RowList<BodyPair>, Rows::BodyPairs(pairs) => pairs, RowList::default(), _is_undecided;
    BodyDistances => RowList<NearestTriangles>,
        Rows::BodyDistances(nearest) => nearest, RowList::default(), _is_undecided;
}

impl sealed::Sealed for Query {}

impl TypedQuery for Query {
    type Rows = Rows;

    fn rows(rows: Rows, _: bool) -> Rows {
        rows
    }
}
