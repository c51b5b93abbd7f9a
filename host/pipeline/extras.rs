//! Parts of a submitted answer that the device makes on request: geometry of rows, rows by feature,
//! least numbers of vertices.

use super::layout::Layout;
use super::list::LONGEST;
use super::narrow::RowSpans;
use super::precision::Precision;
use super::sorter::{counted, sort, words};
use crate::contacts::on_device::{DeviceExtras, DeviceGroups};
use crate::contacts::{DeviceList, GroupBy};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::{launch, purpose};
use bytemuck::Pod;
use nearmiss_kernels::abi::{
    AnswerGeometryArgs, AnswerGroupsArgs, AnswerInfiniteArgs, AnswerKeysArgs, AnswerLeastArgs, AnswerRows,
    Element, Hit, Named, NearHit, Pair, Positions, RowGeometry, Span, by,
};
use nearmiss_kernels::entry::{self, Entry};

/// Memory of the parts of one query's answer.
pub struct Extras {
    geometry: Option<Buffer<RowGeometry>>,
    least: Option<Buffer<u64>>,
    groups: Vec<Groups>,
    /// The meaning of each triangle; empty if all are faces.
    elements: Buffer<Element>,
}

/// Memory of rows by one sort of feature: 20 bytes a key, and some 80 KiB a pass of the sort.
struct Groups {
    by: GroupBy,
    /// Keys of a row.
    width: u32,
    /// How many features there are.
    features: u32,
    keys: [Buffer<u64>; 2],
    /// Counts of each byte that is sorted.
    counts: Buffer<u64>,
    /// The bytes.
    shifts: Vec<u32>,
    starts: Buffer<u32>,
    rows: Buffer<u32>,
}

/// Memory of a frame that the parts are made of.
pub struct Inputs<'a, R: Precision> {
    pub device: &'a Device,
    pub rows: RowSpans,
    pub frames: Positions<R>,
    pub faces: Span<[u32; 3]>,
    pub edges: Span<[u32; 2]>,
}

impl Extras {
    /// Allocates the parts of an answer with these rows; `None` if they have none of the wanted.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], also for more keys than 32 bits number; device errors.
    pub fn new(
        device: &Device,
        wanted: &DeviceExtras,
        layout: &Layout,
        rows: &RowSpans,
    ) -> Result<Option<Extras>, Error> {
        let wanted = wanted.of(rows.are_of_features());
        if wanted.is_empty() {
            return Ok(None);
        }
        let (of_features, room) = (rows.are_of_features(), rows.room());
        let device = device.of(purpose::EXTRAS);
        let vertices = layout.starts.last().copied().unwrap_or_default().vertex as usize;
        let elements: &[Element] = if of_features { &layout.features.elements } else { &[] };
        let groups = wanted.groups.iter().map(|&by| Groups::new(&device, by, (layout, of_features), room));
        Ok(Some(Extras {
            geometry: wanted.geometry.then(|| device.buffer(checked(room)?)).transpose()?,
            least: wanted.least.then(|| device.buffer(vertices)).transpose()?,
            groups: groups.collect::<Result<_, _>>()?,
            elements: device.upload(elements)?,
        }))
    }

    /// Launches what makes them, behind the rows.
    ///
    /// # Errors
    /// Device errors.
    pub fn run<R: Precision>(&mut self, given: &Inputs<R>) -> Result<(), Error> {
        match given.rows {
            RowSpans::Pairs(rows) => {
                let rows = self.whole(rows, given);
                self.group::<Pair, entry::answer_keys_pair>(given.device, rows)
            }
            RowSpans::Contacts(rows) => {
                let rows = self.whole(rows, given);
                self.measure::<R, Hit, R::GeometryOfHits, entry::answer_least_hit>(given, rows)?;
                self.group::<Hit, entry::answer_keys_hit>(given.device, rows)
            }
            RowSpans::Near(rows) => {
                let rows = self.whole(rows, given);
                self.measure::<R, NearHit, R::GeometryOfNear, entry::answer_least_near>(given, rows)?;
                self.group::<NearHit, entry::answer_keys_near>(given.device, rows)
            }
        }
    }

    fn whole<R: Precision, T: Named>(&self, rows: AnswerRows<T>, given: &Inputs<R>) -> AnswerRows<T> {
        AnswerRows { faces: given.faces, edges: given.edges, elements: self.elements.span(), ..rows }
    }

    fn measure<R, T, G, L>(&mut self, given: &Inputs<R>, rows: AnswerRows<T>) -> Result<(), Error>
    where
        R: Precision,
        T: Named,
        G: Entry<Args = AnswerGeometryArgs<R, T>>,
        L: Entry<Args = AnswerLeastArgs<T>>,
    {
        if let Some(geometry) = &self.geometry {
            let args = AnswerGeometryArgs { rows, frames: given.frames, geometry: geometry.span() };
            launch::striding::<G>(given.device, geometry.len(), &args)?;
        }
        if let Some(least) = &self.least {
            let args = AnswerInfiniteArgs { least: least.span() };
            launch::striding::<entry::answer_infinite>(given.device, least.len(), &args)?;
            let args = AnswerLeastArgs { rows, least: least.span() };
            launch::striding::<L>(given.device, given.rows.room(), &args)?;
        }
        Ok(())
    }

    fn group<T: Named, K: Entry<Args = AnswerKeysArgs<T>>>(
        &mut self,
        device: &Device,
        rows: AnswerRows<T>,
    ) -> Result<(), Error> {
        self.groups.iter_mut().try_for_each(|groups| groups.run::<T, K>(device, rows))
    }

    /// Returns the place of the geometry.
    pub fn geometry(&self) -> Option<DeviceList> {
        self.geometry.as_ref().map(list)
    }

    /// Returns the place of the least numbers.
    pub fn least(&self) -> Option<DeviceList> {
        self.least.as_ref().map(list)
    }

    /// Returns the places of the rows of features.
    pub fn groups(&self) -> Vec<DeviceGroups> {
        let of = |own: &Groups| DeviceGroups { by: own.by, starts: list(&own.starts), rows: list(&own.rows) };
        self.groups.iter().map(of).collect()
    }
}

impl Groups {
    fn new(
        device: &Device,
        by: GroupBy,
        (layout, of_features): (&Layout, bool),
        rows: usize,
    ) -> Result<Groups, Error> {
        let ends = layout.starts.last().copied().unwrap_or_default();
        let features = match by {
            GroupBy::Vertex | GroupBy::Corner => ends.vertex,
            GroupBy::Edge => ends.edge,
            GroupBy::Face => ends.triangle,
        };
        let width = match (by, of_features) {
            (GroupBy::Corner, true) => 4,
            (GroupBy::Corner, false) => 6,
            // Only two points are two vertices.
            (GroupBy::Vertex, _) if layout.features.elements.is_empty() => 1,
            (GroupBy::Face, true) => 1,
            _ => 2,
        };
        let keys = checked(rows * width as usize)?;
        // The number behind the last feature is a key, too.
        let bytes = (u32::BITS - features.leading_zeros()).div_ceil(8).max(1);
        let shifts: Vec<u32> = (0..bytes).map(|byte| 32 + 8 * byte).collect();
        Ok(Groups {
            by,
            width,
            features,
            keys: [device.buffer(keys)?, device.buffer(keys)?],
            counts: device.buffer(shifts.len() * words(device, keys as u32))?,
            shifts,
            starts: device.buffer(features as usize + 1)?,
            rows: device.buffer(keys)?,
        })
    }

    fn run<T: Named, K: Entry<Args = AnswerKeysArgs<T>>>(
        &mut self,
        device: &Device,
        rows: AnswerRows<T>,
    ) -> Result<(), Error> {
        let [keys, other] = &self.keys;
        let count = keys.len() as u32;
        self.counts.clear()?;
        let args = AnswerKeysArgs {
            rows,
            keys: keys.span(),
            tiles: counted(device, self.counts.span(), count, 0),
            by: match self.by {
                GroupBy::Vertex => by::VERTEX,
                GroupBy::Edge => by::EDGE,
                GroupBy::Face => by::FACE,
                GroupBy::Corner => by::CORNER,
            },
            width: self.width,
            features: self.features,
            pad: 0,
        };
        launch::striding::<K>(device, keys.len() / self.width as usize, &args)?;
        sort(device, [keys, other], (count, Span::EMPTY), self.counts.span(), &self.shifts)?;
        let sorted = if self.shifts.len().is_multiple_of(2) { keys } else { other };
        let args =
            AnswerGroupsArgs { keys: sorted.span(), starts: self.starts.span(), rows: self.rows.span() };
        launch::striding::<entry::answer_groups>(device, keys.len().max(self.starts.len()), &args)
    }
}

/// Names the first wanted part that no answer has.
pub fn missing(wanted: &DeviceExtras, made: &[&Extras]) -> Option<String> {
    let has = |has: &dyn Fn(&Extras) -> bool| made.iter().any(|own| has(own));
    if wanted.geometry && !has(&|own| own.geometry.is_some()) {
        return Some("geometry of rows".into());
    }
    if wanted.least && !has(&|own| own.least.is_some()) {
        return Some("least numbers of vertices".into());
    }
    let by = wanted.groups.iter().find(|by| !has(&|own| own.groups.iter().any(|groups| groups.by == **by)));
    by.map(|by| format!("rows by {}", by.name()))
}

/// Refuses more entries than lists may have.
fn checked(entries: usize) -> Result<usize, Error> {
    if entries as u64 <= LONGEST {
        return Ok(entries);
    }
    let what = "parts of an answer in device memory".into();
    Err(Error::OutOfMemory { what, asked: 8 * entries as u64, given: 8 * LONGEST })
}

fn list<T: Pod>(buffer: &Buffer<T>) -> DeviceList {
    DeviceList { address: buffer.span().addr(), room: buffer.len() }
}
