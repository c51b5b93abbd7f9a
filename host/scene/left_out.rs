//! Pairs of bodies that are left out.

use super::{BodyId, Scene};
use crate::error::Error;

/// Most pairs of a list: 32 bits number its words, with those of the bodies.
const MOST: u64 = 1 << 31;

impl Scene {
    /// Replaces the list of pairs of bodies that are not tested against each other, by any query.
    /// Links of a robot that share a joint are such pairs. Order and repeats do not matter, and an
    /// empty list leaves out none. A removed body takes its pairs with it.
    ///
    /// ```
    /// use nearmiss::{Body, Mesh, mesh::Positions, scene::Scene};
    ///
    /// let link = |z: f32| {
    ///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    ///     Mesh::new("a link", Positions::F32(corners), vec![[0, 1, 2]])
    /// };
    /// let mut arm = Scene::new();
    /// let [base, elbow, hand] = [arm.add(Body::rigid(link(0.0)?)), arm.add(Body::rigid(link(0.5)?)),
    ///     arm.add(Body::rigid(link(1.0)?))];
    /// arm.leave_out(&[[base, elbow], [hand, elbow]])?;
    /// assert_eq!(arm.left_out(), [[base, elbow], [elbow, hand]]);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, and for a body with itself.
    /// Then the list is as before.
    pub fn leave_out(&mut self, pairs: &[[BodyId; 2]]) -> Result<(), Error> {
        self.left_out = self.checked(pairs)?;
        Ok(())
    }

    /// Pairs of bodies that are left out: the smaller number first, in ascending order.
    pub fn left_out(&self) -> &[[BodyId; 2]] {
        &self.left_out
    }

    /// The pairs as a list keeps them.
    ///
    /// # Errors
    /// As of [`Scene::leave_out`].
    pub(crate) fn checked(&self, pairs: &[[BodyId; 2]]) -> Result<Vec<[BodyId; 2]>, Error> {
        for &[a, b] in pairs {
            if let Some(id) = [a, b].into_iter().find(|&id| self.get(id).is_none()) {
                return Err(Error::InvalidArgument {
                    what: format!("pair ({a}, {b}) cannot be left out: there is no body {id} in the scene"),
                    advice: "name bodies by the numbers that adding them returned".into(),
                });
            }
            if a == b {
                return Err(Error::InvalidArgument {
                    what: format!("pair ({a}, {b}) cannot be left out: it is body {a} with itself"),
                    advice: "set `self_collision` of the body to false".into(),
                });
            }
        }
        let mut list: Vec<[BodyId; 2]> = pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        list.sort_unstable();
        list.dedup();
        fits(list.len() as u64)?;
        Ok(list)
    }

    /// Takes a removed body's pairs away.
    pub(super) fn forget_pairs(&mut self, id: BodyId) {
        self.left_out.retain(|pair| !pair.contains(&id));
    }
}

/// Checks that 32 bits number the pairs.
fn fits(pairs: u64) -> Result<(), Error> {
    if pairs <= MOST {
        return Ok(());
    }
    Err(Error::InvalidArgument {
        what: format!("a list leaves out at most {MOST} pairs of bodies, got {pairs}"),
        advice: "use environments or groups".into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::soup;

    #[test]
    fn a_list_is_a_set_of_pairs_of_bodies_that_are_there() {
        let mut scene = Scene::new();
        let ids = [1, 2, 3, 4].map(|seed| scene.add(soup(3, seed, false)));
        let [a, b, c, d] = ids;
        assert!(scene.left_out().is_empty());
        scene.leave_out(&[[c, b], [a, d], [b, c], [a, b], [c, b]]).expect("bodies");
        let list = [[a, b], [a, d], [b, c]];
        assert_eq!(scene.left_out(), list);
        let refused = |scene: &mut Scene, pairs: &[[BodyId; 2]]| {
            let error = scene.leave_out(pairs).expect_err("refused");
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        };
        let text = refused(&mut scene, &[[a, c], [BodyId(9), a]]);
        assert!(text.contains("(9, 0)") && text.contains("no body 9"), "{text}");
        let text = refused(&mut scene, &[[b, b]]);
        assert!(text.contains("body 1 with itself") && text.contains("`self_collision`"), "{text}");
        assert_eq!(scene.left_out(), list, "a refusal changes nothing");
        scene.remove(b).expect("a body");
        assert_eq!(scene.left_out(), [[a, d]]);
        assert!(refused(&mut scene, &[[a, b]]).contains("no body 1"));
        // Its number begins without pairs.
        assert_eq!(scene.add(soup(3, 5, false)), b);
        assert_eq!(scene.left_out(), [[a, d]]);
        scene.leave_out(&[]).expect("none");
        assert!(scene.left_out().is_empty());
    }

    #[test]
    fn more_pairs_than_32_bits_number_are_refused() {
        assert!(fits(MOST).is_ok());
        let text = fits(MOST + 1).expect_err("too many").to_string();
        assert!(text.contains("2147483649") && text.contains("at most 2147483648"), "{text}");
    }
}
