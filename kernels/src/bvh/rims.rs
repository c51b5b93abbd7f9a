//! Rims of tiles, see [`crate::stage::fit::rims`]: a checker that names a wrong one.

use super::Violation;
use super::tiles::{TILE, Tiles, below};
use crate::abi::Node;
use crate::bv::Contain;
use crate::math::Vec3;

/// Checks the hubs and rims of sound tiles. Each node names the hub that all triangles below it
/// name, or none. Its rim holds, exactly, every other corner of these, moving between its `ends`.
/// `face` returns the corners of a triangle and its hub, see [`crate::abi::NodeFilter::hub`]. Cost:
/// linear, levels times.
///
/// # Errors
/// The first violation, from the first tile on.
pub fn check<V: Contain>(
    tiles: &Tiles<V>,
    rims: &[Node<V>],
    face: impl Fn(u32) -> ([u32; 3], u32),
    ends: impl Fn(u32) -> [Vec3<f64>; 2],
) -> Result<(), Violation> {
    let Tiles { levels, triangles, leaves, .. } = *tiles;
    for (level, part) in (0..levels.count).flat_map(|level| [(level, 0), (level, 1)]) {
        let own = levels.part(level, part, triangles[part]);
        let first = levels.part(0, part, triangles[part]).first * TILE;
        let each = TILE * below(level);
        for i in 0..own.count {
            let node = own.first + i;
            let rim = rims.get(node as usize).ok_or(Violation::Levels)?;
            let end = (i + 1).saturating_mul(each).min(triangles[part]);
            let faces = || (i * each..end).map(|k| face(leaves[(first + k) as usize].triangle()));
            let (_, hub) = faces().next().ok_or(Violation::Levels)?;
            // Fixed tiles are not tested against themselves.
            let is_one = part == 0 && faces().all(|(_, other)| other == hub);
            let held = |v: u32| {
                let [t0, t1] = ends(v);
                rim.volume.holds(t0, t1)
            };
            let is_held =
                |([a, b, c], hub): ([u32; 3], u32)| [a, b, c].into_iter().all(|v| v + 1 == hub || held(v));
            if rim.link != if is_one { hub } else { 0 } || rim.link != 0 && !faces().all(is_held) {
                return Err(Violation::Rim { node });
            }
        }
    }
    Ok(())
}
