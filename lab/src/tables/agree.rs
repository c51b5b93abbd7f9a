//! Checks that all ways to run one query give one answer.

use super::measure::Cell;
use nearmiss::error::Error;
use nearmiss::research::Solver;

/// Returns each cell's frames whose contacts differ from those of the first cell with the same
/// motion. Volumes and walks must not change the answer of an exact solver. A solver that can err
/// may differ, if a volume excludes a pair that it would have got wrong.
///
/// # Errors
/// [`Error::Bug`] with the first cell of an exact solver that differs, and its frame.
pub fn agree(scene: &str, cells: &[Cell]) -> Result<Vec<usize>, Error> {
    let mut differing = Vec::new();
    for cell in cells {
        // The cell itself is one of them.
        let first = cells.iter().find(|other| other.way.moves == cell.way.moves).unwrap_or(cell);
        let differs = |at: &usize| first.hashes.get(*at) != cell.hashes.get(*at);
        let frames: Vec<usize> = (0..first.hashes.len().max(cell.hashes.len())).filter(differs).collect();
        if let (Solver::Exact, Some(frame)) = (cell.solver, frames.first()) {
            return Err(Error::Bug {
                what: format!(
                    "{scene}, {}, frame {frame}: its contacts differ from those of {}, though both are exact",
                    cell.way, first.way
                ),
            });
        }
        differing.push(frames.len());
    }
    Ok(differing)
}

#[cfg(test)]
mod tests {
    use super::super::way::Way;
    use super::*;
    use nearmiss::Stages;
    use nearmiss::research::BoundingVolume;

    fn cell(moves: bool, front: bool, hashes: &[u64]) -> Cell {
        Cell {
            way: Way { moves, volume: BoundingVolume::Aabb, front },
            solver: if moves { Solver::Certified } else { Solver::Exact },
            mean: Stages::default(),
            contacts: 0,
            node_tests: 0,
            triangle_pairs: 0,
            hashes: hashes.to_vec(),
            reruns: 0,
            bytes: 0,
        }
    }

    #[test]
    fn equal_answers_agree() {
        let cells = [cell(false, false, &[1, 2]), cell(true, false, &[3])];
        assert_eq!(agree("s", &cells).expect("agreement"), [0, 0]);
    }

    #[test]
    fn a_wrong_exact_answer_is_named() {
        let cells = [cell(false, false, &[1, 2, 3]), cell(false, true, &[1, 9, 3])];
        let error = agree("flamenco", &cells).expect_err("a planted fault").to_string();
        for part in ["flamenco", "discrete AABB, front", "frame 1", "those of discrete AABB,"] {
            assert!(error.contains(part), "{part}: {error}");
        }
    }

    #[test]
    fn a_missing_frame_is_named() {
        let cells = [cell(false, false, &[1, 2]), cell(false, true, &[1])];
        assert!(agree("s", &cells).expect_err("a planted fault").to_string().contains("frame 1"));
    }

    #[test]
    fn floats_that_differ_are_counted() {
        let cells = [cell(true, false, &[1, 2, 3]), cell(true, true, &[1, 8, 9])];
        assert_eq!(agree("s", &cells).expect("a count"), [0, 2]);
    }
}
