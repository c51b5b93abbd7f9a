//! Single pairs of triangles at one time.

use super::Stored;
use super::lay::AT_ONCE;
use crate::oracle::Triangle;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::mesh::{MAX_ABS_F64, Mesh, Positions};
use nearmiss::query::Query;
use nearmiss::research::pipeline::counts::{Counts, FrameCounters};
use nearmiss::research::pipeline::list::List;
use nearmiss::research::pipeline::narrow::{DiscreteNarrow, Features, NarrowContext};
use nearmiss::research::pipeline::precision::Precision;
use nearmiss::research::{TriangleTest, WithSolver};
use nearmiss_kernels::abi::{self, ExclusionTables, Pair, Point, Span, counter};

/// Answers to a number of triangle pairs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleAnswers {
    /// Whether they share a point, or cross if the query is about that, in the pairs' order.
    pub meet: Vec<bool>,
    /// Number of entries in the list of meeting pairs: each pair must be appended once.
    pub listed: u64,
    /// Pairs that the float filter left to exact signs.
    pub uncertain: u64,
    /// Milliseconds, by the device's clock.
    pub ms: f64,
}

/// Tests whether the triangles of each pair share a point: by the query's solver, with the kernels
/// of a frame.
///
/// # Errors
/// [`Error::InvalidArgument`] for a query other than [`Query::Discrete`], and for coordinates that
/// f32 does not hold if they are stored in f32. [`Error::Input`] for coordinates that no mesh may
/// have. Device errors.
pub fn ask_triangles(
    device: &Device,
    pairs: &[[Triangle; 2]],
    query: &Query,
    stored: Stored,
) -> Result<TriangleAnswers, Error> {
    query.check()?;
    let Query::Discrete(discrete) = query else {
        return Err(Error::InvalidArgument {
            what: format!("triangles at one time need a discrete query, got {}", query.kind().name()),
            advice: "use a discrete query, or `ask` for features in motion".into(),
        });
    };
    let choice = (discrete.chosen(), discrete.is_only_crossing());
    let mut all = TriangleAnswers::default();
    for pairs in pairs.chunks(AT_ONCE) {
        let points: Vec<[f64; 3]> = pairs.iter().flatten().flatten().copied().collect();
        if stored == Stored::F32
            // The mesh refuses numbers that no precision holds.
            && let Some(x) = points
                .iter()
                .flatten()
                .find(|x| x.abs() <= MAX_ABS_F64 && f64::from(**x as f32) != **x)
        {
            return Err(Error::InvalidArgument {
                what: format!("a coordinate is not exact in f32, got {x:e}"),
                advice: "store it in f64".into(),
            });
        }
        let positions = match stored {
            Stored::F64 => Positions::F64(points),
            Stored::F32 => Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect()),
        };
        let faces = (0..2 * pairs.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = Mesh::new("triangle pairs", positions, faces)?;
        let some = match stored {
            Stored::F64 => some::<f64>(device, &mesh, choice)?,
            Stored::F32 => some::<f32>(device, &mesh, choice)?,
        };
        all.meet.extend(some.meet);
        all.listed += some.listed;
        all.uncertain += some.uncertain;
        all.ms += some.ms;
    }
    Ok(all)
}

/// Tests one batch: triangles 2 i and 2 i + 1 are pair i.
fn some<R: Precision>(
    device: &Device,
    mesh: &Mesh,
    (test, only_crossing): (TriangleTest, bool),
) -> Result<TriangleAnswers, Error> {
    let count = mesh.faces().len() / 2;
    let points: Vec<Point<R>> = R::points(mesh.positions()).map(Point::from).collect();
    let (points, faces) = (device.upload(&points)?, device.upload(mesh.faces())?);
    let pairs: Vec<Pair> = (0..count as u32).map(|i| Pair { a: 2 * i, b: 2 * i + 1 }).collect();
    let mut list = List::new(device, "triangle pairs", counter::PAIRS, count)?;
    let mut counts = Counts::default();
    list.put(&pairs, &mut counts)?;
    let mut narrow = DiscreteNarrow::new::<R>(device, test, count)?.only_crossing(only_crossing);
    let mut counters = FrameCounters::new(device)?;
    // Until no list was too short.
    let (counters, ms) = loop {
        counters.write(&counts)?;
        let features = Features::none(device)?;
        let given = NarrowContext {
            device,
            frames: abi::Positions { still: points.span(), moving: Span::EMPTY, turns: Span::EMPTY },
            rest: Span::EMPTY,
            may_grow: true,
            faces: faces.span(),
            pairs: list.output(counters.counters()),
            bodies: Span::EMPTY,
            counters: counters.counters(),
            features: &features,
            excluded: ExclusionTables::NONE,
            placeable: None,
            is_sample: false,
        };
        let start = device.event()?;
        narrow.decide(&given)?;
        let ms = start.to(&device.event()?)?;
        let counted = counters.read()?;
        let mut grew = false;
        for list in narrow.all_lists() {
            grew |= list.grow(device, &counted)?;
        }
        if !grew {
            break (counted, ms);
        }
    };
    let mut meet = vec![false; count];
    narrow.contacts.read(&counters)?.iter().for_each(|pair| meet[pair.a as usize / 2] = true);
    let [listed, uncertain] = [counter::CONTACTS, counter::UNCERTAIN].map(|which| counters[which]);
    Ok(TriangleAnswers { meet, listed, uncertain, ms })
}
