//! The place of each body in the memory that all bodies share.

use super::excluded::Excluded;
use super::hubs;
use crate::error::Error;
use crate::mesh::{self, NO_EDGE, Topology, owners};
use crate::query::QueryKind;
use crate::scene::{Body, BodyId, BodyKind, CollisionFilter, Scene};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::rows::code;
use nearmiss_kernels::abi::{BodyRecord, EVERY, Element, Feature, NodeFilter};
use nearmiss_kernels::bvh::filter::is_left_out;
use std::sync::Arc;

/// Offsets of a body's indices in the layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offsets {
    /// First vertex.
    pub vertex: u32,
    /// First triangle.
    pub triangle: u32,
    /// First edge.
    pub edge: u32,
}

impl Offsets {
    /// Returns the first feature of a list.
    pub fn start(&self, of: Feature) -> u32 {
        match of {
            Feature::VERTEX => self.vertex,
            Feature::TRIANGLE => self.triangle,
            _ => self.edge,
        }
    }

    /// Returns them in the order of [`Feature`].
    pub fn starts(&self) -> [u32; Feature::COUNT as usize] {
        [Feature::VERTEX, Feature::TRIANGLE, Feature::EDGE].map(|of| self.start(of))
    }
}

/// Topology of all bodies in one numbering, body after body. Layouts for several queries of one
/// scene share the long lists.
#[derive(Clone, Default)]
pub struct Layout {
    /// Start of each body, then the end of the last. Edges are numbered if the layout has features.
    pub starts: Vec<Offsets>,
    /// Vertex indices of every triangle.
    pub faces: Arc<Vec<[u32; 3]>>,
    /// Edges and owners; empty without a query of features.
    pub features: Arc<FeatureTopology>,
    /// Records of the bodies for the kernels.
    pub records: Vec<BodyRecord>,
    /// The [`NodeFilter::hub`] of each triangle, if pairs round a hub are no candidates; empty
    /// without hubs.
    pub hubs: Arc<Vec<u32>>,
    /// Hubs of each triangle if pairs round a hub are candidates, so that only the rims exclude
    /// pairs; empty without hubs.
    pub rims: Arc<Vec<u32>>,
    /// The pairs of bodies that are left out, as kernels read them: see `FilterArgs::left_out`;
    /// empty without such.
    pub left_out: Arc<Vec<u32>>,
    /// The thickness of every vertex, a radius; empty in a scene without.
    pub radii: Arc<Vec<f64>>,
    /// Whether it differs within a body.
    pub is_uneven: bool,
    /// Whether a body has vertices with a thickness and vertices without.
    pub is_ragged: bool,
    /// Whether a query may test two features without a thickness, in a scene in which others have one.
    pub meets_thin: bool,
    /// The pairs of features that are excluded, as kernels read them.
    pub excluded: Arc<Excluded>,
    /// The bodies with triangles that may move, and those that are fixed.
    pub trees: [Vec<usize>; 2],
}

/// Edges of all bodies, and the features that each triangle owns.
#[derive(Clone, Default)]
pub struct FeatureTopology {
    /// End points of every edge.
    pub edges: Vec<[u32; 2]>,
    /// Edges of every triangle.
    pub face_edges: Vec<[u32; 3]>,
    /// Features that each triangle owns.
    pub owners: Vec<u32>,
    /// The meaning of each triangle; empty if all are faces.
    pub elements: Vec<Element>,
}

impl Layout {
    /// Returns a layout without bodies.
    pub fn without_bodies() -> Layout {
        Layout { starts: vec![Offsets::default()], ..Layout::default() }
    }

    /// Lays out bodies for a kind of query, one behind the other; numbers edges only if the query
    /// needs them.
    pub fn new(bodies: &[Body], kind: QueryKind) -> Layout {
        // No interrupt ends it.
        Layout::within(bodies, kind, &Looks::new(None)).unwrap_or_default()
    }

    /// As [`Layout::new`], for work that may be interrupted: `None` if it was.
    pub fn within(bodies: &[Body], kind: QueryKind, looks: &Looks) -> Option<Layout> {
        let mut all = Layout::without_bodies();
        let mut at = Offsets::default();
        let mut faces = Vec::new();
        let mut environments: Vec<u32> = bodies.iter().filter_map(|body| body.filter().environment).collect();
        environments.sort_unstable();
        environments.dedup();
        let rank = |environment: u32| environments.partition_point(|&other| other < environment) as u32;
        for (i, body) in bodies.iter().enumerate() {
            let CollisionFilter { environment, group, mask, .. } = *body.filter();
            all.records.push(BodyRecord {
                triangle: at.triangle,
                vertex: at.vertex,
                environment: environment.map_or(EVERY, rank),
                self_collision: (body.self_collides() && kind.is_within_bodies()).into(),
                group,
                mask,
            });
            if body.element_count() > 0 {
                all.trees[usize::from(body.kind() == BodyKind::Fixed)].push(i);
            }
            faces.extend(body.elements().iter().map(|face| face.map(|v| v + at.vertex)));
            at.vertex += body.vertex_count() as u32;
            at.triangle += body.element_count() as u32;
            all.starts.push(at);
        }
        all.faces = Arc::new(faces);
        if bodies.iter().any(|body| body.thickness().largest() > 0.0) {
            let radii = bodies.iter().flat_map(|body| body.thickness().of_vertices(body.vertex_count()));
            all.radii = Arc::new(radii.collect());
            all.is_uneven = bodies.iter().any(|body| body.thickness().same().is_none());
            let is_ragged = |body: &Body| body.thickness().is_partial();
            all.is_ragged = bodies.iter().any(is_ragged);
        }
        if kind.is_of_features() { all.with_features(bodies, looks) } else { Some(all) }
    }

    /// Returns whether vertices have a thickness.
    pub fn is_thick(&self) -> bool {
        !self.radii.is_empty()
    }

    /// Leaves out pairs of bodies, each with the smaller number first, in ascending order. Cost:
    /// linear in pairs, and a search a body.
    pub fn without(self, pairs: &[[BodyId; 2]]) -> Layout {
        if pairs.is_empty() {
            return self;
        }
        // A place for each body, and the end; then the larger numbers.
        let places = self.bodies() + 1;
        let first = |body: usize| places + pairs.partition_point(|[p, _]| p.index() < body);
        let mut list: Vec<u32> = (0..places).map(|body| first(body) as u32).collect();
        list.extend(pairs.iter().map(|[_, q]| q.0));
        Layout { left_out: Arc::new(list), ..self }
    }

    /// Excludes the scene's pairs of features.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Interrupted`].
    pub fn excluding(mut self, scene: &Scene, looks: &Looks) -> Result<Layout, Error> {
        self.excluded = Arc::new(Excluded::new(scene, &self.starts, looks)?);
        self.disowned(looks).ok_or(Error::Interrupted)
    }

    /// Takes features from faces that take no part. Vertices and edges of no other face have no owner
    /// then; no query tests them. `None` if the work was interrupted.
    fn disowned(mut self, looks: &Looks) -> Option<Layout> {
        if self.excluded.faces.is_empty() || !self.has_features() {
            return Some(self);
        }
        let mut features = (*self.features).clone();
        for (body, ends) in self.starts.windows(2).enumerate() {
            let (first, count) = self.triangles(body);
            let own = first as usize..(first + count) as usize;
            if !own.clone().any(|face| self.excluded.has_face(face)) {
                continue;
            }
            let rows = |all: &[[u32; 3]], start: u32| -> Vec<[u32; 3]> {
                let row = |face: usize| match self.excluded.has_face(face) {
                    true => [NO_EDGE; 3],
                    false => all[face].map(|at| if at == NO_EDGE { at } else { at - start }),
                };
                own.clone().map(row).collect()
            };
            let faces = rows(&self.faces, ends[0].vertex);
            let face_edges = rows(&features.face_edges, ends[0].edge);
            let counts = [ends[1].vertex - ends[0].vertex, ends[1].edge - ends[0].edge];
            features.owners[own.clone()].copy_from_slice(&owners(&faces, &face_edges, counts, looks)?);
        }
        self.features = Arc::new(features);
        Some(self)
    }

    /// Adds edges and owners of the same bodies; `None` if the work was interrupted. Cost: linear
    /// in triangles.
    pub fn with_features(mut self, bodies: &[Body], looks: &Looks) -> Option<Layout> {
        let mut features = FeatureTopology::default();
        let has_elements = bodies.iter().any(|body| body.element_count() > body.face_count());
        for (i, body) in bodies.iter().enumerate() {
            let own = Topology::of_body(body, looks)?;
            let (vertex, edge) = (self.starts[i].vertex, features.edges.len() as u32);
            features.edges.extend(own.edges.iter().map(|edge| edge.map(|v| v + vertex)));
            // An edge that does not exist has no owner, so its number is never used.
            let numbered = |face: &[u32; 3]| face.map(|e| e.saturating_add(edge));
            features.face_edges.extend(own.face_edges.iter().map(numbered));
            features.owners.extend(&own.owners);
            self.starts[i + 1].edge = features.edges.len() as u32;
            if has_elements {
                let first = features.elements.len();
                let element = |at: usize| {
                    let (kind, number) = match body.element_kind(at) {
                        mesh::Element::Face => (code::VERTEX_FACE, (first + at) as u32),
                        mesh::Element::Edge => (code::EDGE_VERTEX, features.face_edges[first + at][0]),
                        mesh::Element::Point => (code::VERTEX_VERTEX, body.elements()[at][0] + vertex),
                    };
                    Element { kind: kind.into(), number }
                };
                let elements: Vec<Element> = (0..body.element_count()).map(element).collect();
                features.elements.extend(elements);
            }
        }
        self.features = Arc::new(features);
        self.disowned(looks)
    }

    /// Returns the layout of the same bodies for a query of another kind, without hubs.
    pub fn seen_by(&self, bodies: &[Body], kind: QueryKind) -> Layout {
        let mut layout = Layout { hubs: Arc::default(), rims: Arc::default(), ..self.clone() };
        for (record, body) in layout.records.iter_mut().zip(bodies) {
            record.self_collision = (body.self_collides() && kind.is_within_bodies()).into();
        }
        layout
    }

    /// Returns what a triangle stands for.
    pub fn element(&self, triangle: u32) -> Element {
        self.features.elements.get(triangle as usize).copied().unwrap_or(Element::face(triangle))
    }

    /// Returns whether edges are numbered.
    pub fn has_features(&self) -> bool {
        !self.features.owners.is_empty()
    }

    /// Returns the layout of one body of `triangles` triangles, to build a tree over it.
    pub fn single(triangles: u32) -> Layout {
        Layout {
            starts: vec![Offsets::default(), Offsets { triangle: triangles, ..Offsets::default() }],
            records: vec![BodyRecord { self_collision: 1, ..BodyRecord::default() }],
            trees: [vec![0], Vec::new()],
            ..Layout::default()
        }
    }

    /// Finds the hubs of bodies that are tested against themselves. `keeps_adjacent` is whether the
    /// query keeps adjacent pairs. Cost: linear.
    pub fn find_hubs(&mut self, keeps_adjacent: bool) {
        let own = |record: &BodyRecord| record.self_collision != 0;
        if !self.records.iter().any(own) {
            return;
        }
        let vertices = self.starts.last().map_or(0, |end| end.vertex as usize);
        let mut hubs = hubs::of(&self.faces, vertices);
        for body in (0..self.bodies()).filter(|&body| !own(&self.records[body])) {
            let (first, count) = self.triangles(body);
            // The list is empty if there is no hub at all.
            if let Some(others) = hubs.get_mut(first as usize..(first + count) as usize) {
                others.fill(0);
            }
        }
        if hubs.iter().any(|&hub| hub != 0) {
            *if keeps_adjacent { &mut self.rims } else { &mut self.hubs } = Arc::new(hubs);
        }
    }

    /// Returns the number of bodies.
    pub fn bodies(&self) -> usize {
        self.starts.len() - 1
    }

    /// Returns whether anything may meet. One body must move; it needs another body, or is tested
    /// against itself.
    pub fn may_meet(&self) -> bool {
        let [moving, fixed] = &self.trees;
        let alone = moving.len() == 1 && fixed.is_empty();
        !moving.is_empty() && (!alone || self.records[moving[0]].self_collision != 0)
    }

    /// Returns whether triangles of two bodies, or of a body and itself, are tested against each
    /// other. It decides as `FilterArgs::allows` does.
    pub fn tests(&self, a: usize, b: usize) -> bool {
        let is_fixed = |body: usize| self.trees[1].binary_search(&body).is_ok();
        if [a, b].iter().any(|&body| self.triangles(body).1 == 0) || (is_fixed(a) && is_fixed(b)) {
            return false;
        }
        if a == b {
            return self.records[a].self_collision != 0;
        }
        let meets = |body: usize| {
            let BodyRecord { environment, group, mask, .. } = self.records[body];
            let environment = (environment != EVERY).then_some(environment);
            CollisionFilter { environment, group, mask, ..CollisionFilter::default() }
        };
        let word = |i: u32| self.left_out[i as usize];
        let is_listed = !self.left_out.is_empty() && is_left_out(a as u32, b as u32, word);
        meets(a).allows(&meets(b)) && !is_listed
    }

    /// Returns whether the tested pairs depend on their bodies, or on hubs.
    pub fn has_filters(&self) -> bool {
        self.has_several() || !self.hubs.is_empty()
    }

    /// Returns whether several bodies have triangles.
    pub fn has_several(&self) -> bool {
        self.trees.iter().map(Vec::len).sum::<usize>() > 1
    }

    /// Returns whether the tested pairs depend on groups, too.
    pub fn has_groups(&self) -> bool {
        let all = |record: &BodyRecord| record.group == u32::MAX && record.mask == u32::MAX;
        !self.records.iter().all(all)
    }

    /// Returns the filter of each triangle, as kernels read it.
    pub fn whose(&self) -> impl Iterator<Item = NodeFilter> {
        let of = move |body: usize| {
            let (first, count) = self.triangles(body);
            (first..first + count).map(move |triangle| {
                let hub = self.hubs.get(triangle as usize).copied().unwrap_or(0);
                NodeFilter::leaf(body as u32, &self.records[body], hub)
            })
        };
        (0..self.bodies()).flat_map(of)
    }

    /// Returns how many triangles may move. Every candidate has one of them.
    pub fn moving_triangles(&self) -> usize {
        self.trees[0].iter().map(|&body| self.triangles(body).1 as usize).sum()
    }

    /// Returns the body of an index in the layout, and the index in the body; `of` selects the kind
    /// of index.
    pub fn locate(&self, index: u32, of: impl Fn(&Offsets) -> u32) -> (BodyId, u32) {
        // Bodies without such a feature start where the next one does, so the last of them is the
        // owner.
        let body = self.starts.partition_point(|start| of(start) <= index) - 1;
        (BodyId(body as u32), index - of(&self.starts[body]))
    }

    /// As [`Layout::locate`], for an index that is mostly in the body `near`, which becomes its body.
    pub fn locate_near(&self, near: &mut usize, index: u32, of: impl Fn(&Offsets) -> u32) -> (BodyId, u32) {
        let is_there = |body: usize| of(&self.starts[body]) <= index && index < of(&self.starts[body + 1]);
        if !is_there(*near) {
            *near = self.locate(index, &of).0.0 as usize;
        }
        (BodyId(*near as u32), index - of(&self.starts[*near]))
    }

    /// Returns the triangles of a body: the first, and how many.
    pub fn triangles(&self, body: usize) -> (u32, u32) {
        let first = self.starts[body].triangle;
        (first, self.starts[body + 1].triangle - first)
    }
}
