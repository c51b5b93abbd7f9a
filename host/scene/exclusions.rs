//! Pairs of features that are left out: by rings of neighbours, by a rest shape, by pairs of
//! vertices, by faces.

use super::{Body, BodyId, Scene};
use crate::error::Error;
use crate::mesh::Positions;
use crate::query::QueryKind;
use std::collections::BTreeMap;

/// Features of a body that are not tested against others of the same body, and faces that take no
/// part: see [`Scene::exclude`]. A feature is a vertex, an edge or a face.
///
/// ```
/// use nearmiss::scene::{Exclusions, RestShape, Scene};
/// use nearmiss::{Body, Mesh, mesh::Positions};
///
/// let positions = Positions::F32(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
/// let rest = RestShape { within: 0.01, positions: positions.clone() };
/// let mut scene = Scene::new();
/// let cloth = scene.add(Body::deformable(Mesh::new("cloth", positions, vec![[0, 1, 2], [1, 3, 2]])?));
/// scene.exclude(cloth, Exclusions { ring: Some(2), rest: Some(rest), ..Exclusions::default() })?;
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exclusions {
    /// Ring of neighbours, from 1. A pair of features is left out if some vertex of one and some
    /// vertex of the other have at most `ring - 1` edges between them. Ring 1 has pairs with a
    /// common vertex. All queries leave these out, except a discrete one that keeps adjacent
    /// triangles. Ring 2 also has pairs that an edge joins.
    pub ring: Option<u32>,
    /// Shape at rest. Pairs of features that are nearer there than its distance are left out.
    pub rest: Option<RestShape>,
    /// Faces that take no part, and with them the vertices and edges of no other face. The answer
    /// is the one of a body without these faces.
    pub faces: Vec<u32>,
}

/// A shape of a body at rest, and a distance in it.
#[derive(Clone, Debug, PartialEq)]
pub struct RestShape {
    /// Pairs of features that are nearer than this at rest are left out, as computed in f64. The
    /// error is that of a near query. A length from 0; 0 leaves out none.
    pub within: f64,
    /// A position for each vertex.
    pub positions: Positions,
}

/// All exclusions of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Excluded {
    /// Those within bodies; of each that has any.
    pub bodies: BTreeMap<BodyId, Exclusions>,
    /// Pairs of vertices, by their bodies: the smaller number first. Each list ascends, and within a
    /// body each pair.
    pub pairs: BTreeMap<[BodyId; 2], Vec<[u32; 2]>>,
}

impl Excluded {
    /// Whether nothing is excluded.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty() && self.pairs.is_empty()
    }

    /// Replaces those of a body by checked ones.
    pub fn set(&mut self, id: BodyId, own: Option<Exclusions>) {
        match own {
            Some(own) => self.bodies.insert(id, own),
            None => self.bodies.remove(&id),
        };
    }

    /// Replaces a list of pairs by a checked one.
    pub fn set_pairs(&mut self, (key, list): ([BodyId; 2], Vec<[u32; 2]>)) {
        if list.is_empty() {
            self.pairs.remove(&key);
        } else {
            self.pairs.insert(key, list);
        }
    }

    /// Takes away what concerns a body.
    pub fn forget(&mut self, id: BodyId) {
        self.bodies.remove(&id);
        self.pairs.retain(|bodies, _| !bodies.contains(&id));
    }
}

impl Scene {
    /// Replaces the exclusions of a body. [`Exclusions::default`] has none. A body that is removed
    /// or [replaced](crate::Detector::replace) loses them: its vertices may have other numbers.
    ///
    /// Queries of features and of triangles obey. Two triangles are left out as any other features
    /// are. Queries of distances and of pairs of bodies are refused.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, a ring of 0, a distance that
    /// is negative or not finite, a rest shape of another number of vertices, and a face that does
    /// not exist. [`Error::Input`] for a position that no mesh may have. Then nothing has changed.
    pub fn exclude(&mut self, id: BodyId, exclusions: Exclusions) -> Result<(), Error> {
        let own = self.checked_exclusions(id, exclusions)?;
        self.excluded.set(id, own);
        Ok(())
    }

    /// Exclusions of a body; `None` without any.
    pub fn exclusions(&self, id: BodyId) -> Option<&Exclusions> {
        self.excluded.bodies.get(&id)
    }

    /// Replaces the list of pairs of vertices of two bodies, or of one with itself. The first vertex
    /// of each pair is of the first body. A pair of features is left out if the list has a vertex of
    /// one and a vertex of the other. An empty list leaves out none. A body that is removed or
    /// [replaced](crate::Detector::replace) takes its lists with it.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a body that is not in the scene, a vertex that does not exist,
    /// and a vertex with itself. Then nothing has changed.
    pub fn exclude_pairs(&mut self, bodies: [BodyId; 2], pairs: &[[u32; 2]]) -> Result<(), Error> {
        let list = self.checked_pairs(bodies, pairs)?;
        self.excluded.set_pairs(list);
        Ok(())
    }

    /// Pairs of vertices of two bodies that are left out, ascending.
    pub fn excluded_pairs(&self, [a, b]: [BodyId; 2]) -> Vec<[u32; 2]> {
        let list = self.excluded.pairs.get(&[a.min(b), a.max(b)]).cloned().unwrap_or_default();
        if a <= b {
            return list;
        }
        let mut list: Vec<_> = list.into_iter().map(|[p, q]| [q, p]).collect();
        list.sort_unstable();
        list
    }

    /// Checks exclusions of a body, and orders their faces. `None` without any.
    ///
    /// # Errors
    /// As of [`Scene::exclude`].
    pub(crate) fn checked_exclusions(
        &self,
        id: BodyId,
        mut own: Exclusions,
    ) -> Result<Option<Exclusions>, Error> {
        let body = self.one_of(id)?;
        own.faces.sort_unstable();
        own.faces.dedup();
        check(body, &own)?;
        Ok((own != Exclusions::default()).then_some(own))
    }

    /// Checks pairs of vertices of two bodies. Returns them as [`Excluded::pairs`] has them.
    ///
    /// # Errors
    /// As of [`Scene::exclude_pairs`].
    pub(crate) fn checked_pairs(
        &self,
        [a, b]: [BodyId; 2],
        pairs: &[[u32; 2]],
    ) -> Result<([BodyId; 2], Vec<[u32; 2]>), Error> {
        let (first, second) = (self.one_of(a)?, self.one_of(b)?);
        for &[p, q] in pairs {
            let sides = [(first, p), (second, q)];
            if let Some((body, vertex)) =
                sides.into_iter().find(|(body, v)| *v as usize >= body.vertex_count())
            {
                return Err(missing("vertex", "vertices", vertex, body, body.vertex_count()));
            }
            if a == b && p == q {
                return Err(Error::InvalidArgument {
                    what: format!("pair ({p}, {q}) of {} is a vertex with itself", first.name()),
                    advice: "name two vertices".into(),
                });
            }
        }
        let ordered = |&[p, q]: &[u32; 2]| if a > b || (a == b && p > q) { [q, p] } else { [p, q] };
        let mut list: Vec<[u32; 2]> = pairs.iter().map(ordered).collect();
        list.sort_unstable();
        list.dedup();
        Ok(([a.min(b), a.max(b)], list))
    }

    /// Refuses a kind of query that does not obey exclusions, if there are any.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`].
    pub(crate) fn may_exclude(&self, kind: QueryKind) -> Result<(), Error> {
        if self.excluded.is_empty() || kind.is_within_bodies() && !kind.is_of_bodies() {
            return Ok(());
        }
        Err(Error::InvalidArgument {
            what: format!("a {kind} query cannot leave out pairs of features, and the scene excludes some"),
            advice: "leave out pairs of bodies, or use a scene without exclusions".into(),
        })
    }

    fn one_of(&self, id: BodyId) -> Result<&Body, Error> {
        self.get(id).ok_or_else(|| Error::InvalidArgument {
            what: format!("nothing of body {id} can be excluded: it is not in the scene"),
            advice: "name bodies by the numbers that adding them returned".into(),
        })
    }
}

/// Checks the exclusions of a body; the faces ascend.
fn check(body: &Body, own: &Exclusions) -> Result<(), Error> {
    let refused = |what: String, advice: &str| Err(Error::InvalidArgument { what, advice: advice.into() });
    let name = body.name();
    if own.ring == Some(0) {
        return refused(
            format!("the ring of neighbours of {name} must be at least 1, got 0"),
            "give 1 for common vertices, 2 for one edge between",
        );
    }
    if let Some(RestShape { within, positions }) = &own.rest {
        if !(within.is_finite() && *within >= 0.0) {
            return refused(
                format!("the distance at rest of {name} must be finite and at least 0, got {within}"),
                "give a length in units of the mesh",
            );
        }
        let [theirs, ours] = [positions.len(), body.vertex_count()];
        if theirs != ours {
            return refused(
                format!("the rest shape of {name} has {theirs} positions, and the body {ours} vertices"),
                "give one position for each vertex",
            );
        }
        body.is_single(positions.into())?;
    }
    match own.faces.last() {
        Some(&face) if face as usize >= body.element_count() => {
            Err(missing("face", "faces", face, body, body.element_count()))
        }
        _ => Ok(()),
    }
}

fn missing(one: &str, several: &str, index: u32, body: &Body, count: usize) -> Error {
    let name = body.name();
    Error::InvalidArgument {
        what: format!("{one} {index} of {name} cannot be excluded: it has {count} {several}"),
        advice: format!("count {several} from 0; after another mesh, exclude again by its numbers"),
    }
}
