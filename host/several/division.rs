//! Each device's share of a query's work.

use super::MultiDetector;
use super::cuts::cuts;
use crate::detector::Detector;
use crate::error::Error;
use crate::pipeline::Share;
use crate::pipeline::wear::Wear;
use crate::query::Query;

/// A frame is uneven if the slowest share takes more than this many times the mean. The next frame
/// is then divided again, by the cost of each tile. Equal frames differ by less, some hundredths.
const UNEVEN: f64 = 1.05;

/// Division of a query's work.
pub(super) struct Division {
    /// Shape of the query.
    pub shape: Query,
    pub shares: Vec<Share>,
    /// Milliseconds of the last frame, by each device's own clock.
    pub ms: Vec<f64>,
    pub wear: Wear,
}

impl Division {
    /// Equal numbers of tiles for `count` devices.
    fn even(shape: Query, count: usize) -> Division {
        let part = |k: usize| k as u64 * Share::ALL / count as u64;
        let shares = (0..count).map(|k| Share { from: part(k), to: part(k + 1) }).collect();
        Division { shape, shares, ms: vec![0.0; count], wear: Wear::default() }
    }
}

/// Work of a device in a frame.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DeviceShare {
    /// Name of the machine.
    pub device: String,
    /// Its part of the tiles, 0 to 1, in the last frame.
    pub tiles: f64,
    /// Milliseconds of that frame, by its own clock; 0 before the first frame.
    pub ms: f64,
}

impl MultiDetector {
    /// Returns each device's part of the last frame of a query; empty before the first frame.
    pub fn shares(&self, query: &Query) -> Vec<DeviceShare> {
        let shape = self.divisible(*query).ok().map(|query| query.shape());
        let division = self.divisions.iter().find(|division| shape == Some(division.shape));
        let one = |((part, share), &ms): ((&Detector, &Share), &f64)| DeviceShare {
            device: part.machine(),
            tiles: (share.to - share.from) as f64 / Share::ALL as f64,
            ms,
        };
        let of = |division: &Division| {
            self.parts.iter().zip(&division.shares).zip(&division.ms).map(one).collect()
        };
        division.map_or_else(Vec::new, of)
    }

    /// Returns the index of a query's division, which is even at first.
    pub(super) fn division(&mut self, query: &Query) -> usize {
        let shape = query.shape();
        self.divisions.iter().position(|division| division.shape == shape).unwrap_or_else(|| {
            self.divisions.push(Division::even(shape, self.parts.len()));
            self.divisions.len() - 1
        })
    }

    /// Gives every device its share, divided again if the last frame was uneven.
    pub(super) fn divide(&mut self, at: usize, query: &Query) -> Result<(), Error> {
        let ms = &self.divisions[at].ms;
        let (sum, most) = (ms.iter().sum::<f64>(), ms.iter().copied().fold(0.0, f64::max));
        if most * ms.len() as f64 > UNEVEN * sum {
            self.divisions[at].shares = self.cut(&[(at, *query)])?;
        }
        self.parts.iter_mut().zip(&self.divisions[at].shares).for_each(|(part, share)| part.take(*share));
        Ok(())
    }

    /// Cuts the tiles by their cost in the last frames of some queries, with their divisions.
    pub(super) fn cut(&mut self, queries: &[(usize, Query)]) -> Result<Vec<Share>, Error> {
        let mut costs: Vec<f64> = Vec::new();
        for (at, query) in queries {
            for (part, ms) in self.parts.iter_mut().zip(&self.divisions[*at].ms) {
                let work = part.tile_work(query)?;
                let all: u64 = work.iter().sum();
                costs.resize(costs.len().max(work.len()), 0.0);
                let a_unit = ms / all.max(1) as f64;
                costs.iter_mut().zip(&work).for_each(|(cost, &work)| *cost += work as f64 * a_unit);
            }
        }
        let cuts = cuts(&costs, self.parts.len());
        Ok(cuts.windows(2).map(|ends| Share { from: ends[0], to: ends[1] }).collect())
    }
}
