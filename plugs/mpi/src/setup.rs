//! Agreement of ranks about bodies, and motions of pieces.

use crate::error::{RankError, refused};
use crate::piece::Piece;
use crate::place::chosen;
use crate::ranks::{Purpose, Ranks};
use mpi::collective::SystemOperation;
use nearmiss::mesh::{Points, Positions};
use nearmiss::scene::{BodyKind, Motion, mean_side, of_mean_side};
use nearmiss::{Body, Error, Mesh};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Checks that all ranks have the same bodies, except for positions and triangles.
///
/// # Errors
/// With the first body that differs from rank 0's.
pub(crate) fn agree(ranks: &Ranks, pieces: &[Piece], left_out: &[[usize; 2]]) -> Result<(), RankError> {
    let counts = ranks.gathered(&[pieces.len() as u64], Purpose::Setup);
    ranks.agree(match counts[0] == pieces.len() as u64 {
        true => Ok(()),
        false => {
            let what = format!("{} pieces, but rank 0 has {}", pieces.len(), counts[0]);
            Err(refused(what, "give a piece of every body on each rank, also an empty one"))
        }
    })?;
    let digests: Vec<u64> = pieces.iter().map(digest).chain([hash(&left_out)]).collect();
    let all = ranks.gathered(&digests, Purpose::Setup);
    let differs = digests.iter().zip(&all).position(|(own, first)| own != first);
    let bad_pair = left_out.iter().find(|[a, b]| a == b || *b >= pieces.len());
    ranks.agree(match (differs, bad_pair) {
        (Some(at), _) => Err(match pieces.get(at) {
            Some(piece) => refused(
                format!("body {at}, {}, differs from that of rank 0", piece.body.name()),
                "give it the same name, kind, filter, thickness, tolerance and numbers of the whole",
            ),
            None => refused("pairs of bodies that are left out differ from those of rank 0", "give the same"),
        }),
        (None, Some([a, b])) => Err(refused(
            format!("pair ({a}, {b}) cannot be left out"),
            "give two different bodies of the scene",
        )),
        (None, None) => Ok(()),
    })
}

/// Returns a hash by which ranks compare what they were given.
pub(crate) fn hash(of: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

fn digest(piece: &Piece) -> u64 {
    let body = &piece.body;
    let filter = body.filter();
    let radius = body.thickness().largest().to_bits();
    let kind = match body.kind() {
        BodyKind::Fixed => 0,
        BodyKind::Rigid => 1,
        _ => 2,
    };
    let filter = (filter.environment, filter.group, filter.mask, filter.self_collision);
    hash(&(body.name(), kind, filter, radius, piece.whole, piece.tolerance.map(f64::to_bits)))
}

/// Returns the default tolerance of each whole body.
///
/// # Errors
/// If rounding of the sum of all sides decides it.
pub(crate) fn tolerances(ranks: &Ranks, pieces: &[Piece]) -> Result<Vec<f64>, RankError> {
    let own = |piece: &Piece| {
        let sides = 3.0 * piece.faces.len() as f64;
        [mean_side(std::slice::from_ref(&piece.body)) * sides, sides, piece.body.default_tolerance()]
    };
    let own: Vec<f64> = pieces.iter().flat_map(own).collect();
    let all = ranks.gathered(&own, Purpose::Setup);
    let each = |(at, piece): (usize, &Piece)| {
        if let Some(tolerance) = piece.tolerance {
            return Ok(tolerance);
        }
        let parts: Vec<&[f64]> = all.chunks(own.len()).map(|rank| &rank[3 * at..3 * at + 3]).collect();
        let parts: Vec<&[f64]> = parts.into_iter().filter(|part| part[1] > 0.0).collect();
        if let [] | [_] = parts[..] {
            return Ok(parts.first().map_or(0.0, |part| part[2]));
        }
        let mean =
            parts.iter().map(|part| part[0]).sum::<f64>() / parts.iter().map(|part| part[1]).sum::<f64>();
        let [least, most] = [1.0 - SUMMED, 1.0 + SUMMED].map(|by| of_mean_side(mean * by));
        if least == most {
            return Ok(least);
        }
        let what = format!("the default tolerance of {} depends on the rounding of a sum", piece.body.name());
        Err(refused(what, "give each piece of it a default tolerance"))
    };
    ranks.run(|| pieces.iter().enumerate().map(each).collect())
}

/// Relative error of a mean of all sides, at most: 2^33 terms, rounded once each.
const SUMMED: f64 = 1.0 / (1 << 20) as f64;

/// Checks motions of pieces.
///
/// # Errors
/// As of [`Body::check`], with numbers of the whole body.
pub(crate) fn check_motions(pieces: &[Piece], motions: &[(usize, Motion)]) -> Result<(), Error> {
    for (at, (body, motion)) in motions.iter().enumerate() {
        let piece = pieces.get(*body).ok_or_else(|| no_body(*body, pieces))?;
        if motions[..at].iter().any(|(other, _)| other == body) {
            let what = format!("two motions for body {body}, {}", piece.body.name());
            return Err(refused(what, "give one motion for each body"));
        }
        if matches!(motion, Motion::OnDevice(_)) {
            let what = format!("positions of {} are in memory of a device", piece.body.name());
            return Err(refused(what, "give positions in host memory"));
        }
        piece.body.check(motion).map_err(|error| piece.in_whole(error))?;
    }
    Ok(())
}

fn no_body(body: usize, pieces: &[Piece]) -> Error {
    refused(format!("there is no body {body}: the scene has {}", pieces.len()), "give a number below that")
}

/// Motion of a piece, with its own positions.
pub(crate) enum Part<'a> {
    Positions(Vec<Positions>),
    Whole(Motion<'a>),
}

impl Part<'_> {
    pub fn motion(&self) -> Motion<'_> {
        match self {
            Part::Positions(ends) => match &ends[..] {
                [at] => Motion::positions(at),
                [start, .., end] => Motion::step(start, end),
                [] => Motion::positions(&[] as &[[f32; 3]]),
            },
            Part::Whole(motion) => *motion,
        }
    }
}

/// Returns a piece's part of a motion of the whole body.
///
/// # Errors
/// [`Error::InvalidArgument`] for another number of positions than the whole body has vertices.
pub(crate) fn part_of<'a>(
    pieces: &[Piece],
    body: usize,
    motion: &Motion<'a>,
) -> Result<(usize, Part<'a>), Error> {
    let piece = pieces.get(body).ok_or_else(|| no_body(body, pieces))?;
    let part = |points: &Points| {
        if points.len() != piece.whole[0] as usize {
            let (name, count) = (piece.body.name(), piece.whole[0]);
            let what = format!("{name} has {count} vertices, and {} positions were given", points.len());
            return Err(refused(what, "give one for each vertex of the whole body"));
        }
        Ok(chosen(*points, &piece.vertices))
    };
    let ends: &[Points] = match motion {
        Motion::Positions(at) => std::slice::from_ref(at),
        Motion::Step(ends) => ends,
        other => return Ok((body, Part::Whole(*other))),
    };
    Ok((body, Part::Positions(ends.iter().map(part).collect::<Result<_, _>>()?)))
}

impl Piece {
    /// Applies a motion that [`check_motions`] accepts.
    pub(crate) fn put(&mut self, motion: Motion) -> Result<(), Error> {
        let nothing = Body::deformable(Mesh::new("", Positions::F32(Vec::new()), Vec::new())?);
        self.body = std::mem::replace(&mut self.body, nothing).at(motion)?;
        Ok(())
    }

    /// Rests where the last step ended.
    pub(crate) fn rest(&mut self) -> Result<(), Error> {
        match self.body.kind() {
            BodyKind::Fixed => Ok(()),
            BodyKind::Rigid => self.put(Motion::Pose(self.body.poses()[1])),
            _ => match self.body.positions_t1().cloned() {
                Some(end) => self.put(Motion::positions(&end)),
                None => Ok(()),
            },
        }
    }
}

/// Checks that ranks agree in a number.
///
/// # Errors
/// `different`, from the first rank whose number is not that of rank 0.
pub(crate) fn same(ranks: &Ranks, number: u64, different: impl FnOnce() -> Error) -> Result<(), RankError> {
    let [least, most] =
        [SystemOperation::min(), SystemOperation::max()].map(|by| ranks.reduced([number], by)[0]);
    if least == most {
        return Ok(());
    }
    let all = ranks.gathered(&[number], Purpose::Setup);
    ranks.agree(if number == all[0] { Ok(()) } else { Err(different()) })
}
