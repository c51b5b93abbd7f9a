//! Bodies, and scenes of them.

use crate::errors::{choice, one_of, raised};
use crate::exclusions;
use crate::filter::{environment_of, group_of, mask_of};
use crate::host::{Most, faces, points, positions, rows, vertices_of};
use crate::key::{self, Key, Pairs, bodies, body_of, numbers, pairs_of};
use crate::matrix::pose_of;
use crate::pose::Pose;
use crate::query::{Remade, remade};
use crate::thickness::{self, thickness_of};
use nearmiss::scene::{BodyKind, CollisionFilter};
use nearmiss::words::counted;
use nearmiss::{Mesh, Thickness};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Mesh that takes part in a scene: its way to move, and the bodies that it may meet.
///
/// - `vertices`: (n, 3) numbers, copied. float32 and float64 are kept, others become float64.
/// - `faces`: (m, 3) integers from 0, the vertices of each triangle, copied. It may be empty if there
///   are edges or points.
/// - `kind`: "deformable" (each vertex moves by itself), "rigid" (moves by a Pose) or "fixed" (never
///   moves; cheapest).
/// - `self_collision`: whether the body is tested against itself. Default: deformable bodies are,
///   rigid bodies are not. Fixed bodies never are: True raises InvalidArgumentError.
/// - `environment`: bodies of different environments never meet; None is in all of them.
/// - `group`, `mask`: 32 bits each. Two bodies meet if each is in a group of the other's mask. ~1
///   is all bits except the lowest.
/// - `name`: name of the body in messages; it may be used in place of its number.
/// - `pose`: of a rigid body, where it begins: a Pose or a (4, 4) array. Default: where its mesh is.
/// - `thickness`: radius around the surface that belongs to the body, a length of at least 0; or one
///   for each vertex, in between linear. Near queries and queries in motion add those of both bodies
///   to their distance; all others ignore them.
/// - `edges`: (k, 2) integers. Edges of no face take part by themselves, as hair and threads do. Edges
///   of answers have their numbers in this list; those of faces that it lacks come behind, by
///   (larger vertex, smaller vertex).
/// - `points`: vertices that take part by themselves, as particles do. Those of a face or an edge do
///   anyway.
///
/// Raises InvalidArgumentError for a thickness that is no length.
/// Raises InputError for vertices that are not finite and for indices without a vertex.
#[pyclass(module = "nearmiss", frozen)]
pub struct Body {
    pub body: nearmiss::Body,
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(
        signature = (
            vertices, faces, *, kind = "deformable", self_collision = None, environment = Some(0),
            group = u32::MAX, mask = u32::MAX, name = "a mesh", pose = None, thickness = None,
            edges = None, points = None,
        ),
        text_signature = "(vertices, faces, *, kind='deformable', self_collision=None, environment=0, \
            group=0xFFFFFFFF, mask=0xFFFFFFFF, name='a mesh', pose=None, thickness=0.0, \
            edges=None, points=None)"
    )]
    #[allow(clippy::too_many_arguments, reason = "they are named")]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        kind: &str,
        self_collision: Option<bool>,
        #[pyo3(from_py_with = environment_of)] environment: Option<u32>,
        #[pyo3(from_py_with = group_of)] group: u32,
        #[pyo3(from_py_with = mask_of)] mask: u32,
        name: &str,
        pose: Option<Bound<'_, PyAny>>,
        thickness: Option<Bound<'_, PyAny>>,
        edges: Option<Bound<'_, PyAny>>,
        points: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Body> {
        let make = match kind {
            "deformable" => nearmiss::Body::deformable,
            "rigid" => nearmiss::Body::rigid,
            "fixed" => nearmiss::Body::fixed,
            other => {
                return Err(choice(
                    format!("kind has no choice {other:?}"),
                    one_of(["deformable", "rigid", "fixed"]),
                ));
            }
        };
        let given = positions(vertices, &format!("vertices of {name}"), Most::OfAnyMesh)?;
        let triangles = self::faces(faces, name, given.len())?;
        let on_itself = self_collision;
        let thickness = thickness.map_or(Ok(Thickness::default()), |given| thickness_of(&given, name))?;
        let filter = CollisionFilter { environment, group, mask, self_collision: on_itself };
        let edges = edges.map_or(Ok(Vec::new()), |edges| vertices_of(&edges, &format!("edges of {name}")))?;
        let points: Vec<[u32; 1]> =
            points.map_or(Ok(Vec::new()), |points| vertices_of(&points, &format!("points of {name}")))?;
        let made = py.detach(|| {
            let mesh =
                Mesh::new(name, given, triangles)?.with_edges(edges)?.with_points(points.into_flattened())?;
            Ok(make(mesh).with_filter(filter).with_thickness(thickness))
        });
        let body = made.and_then(|body| body.validate().map(|()| body)).map_err(raised)?;
        let Some(pose) = pose else { return Ok(Body { body }) };
        if body.kind() != BodyKind::Rigid {
            return Err(choice(
                format!("pose of {name}, which is {kind}"),
                "use kind=\"rigid\", or leave pose out",
            ));
        }
        let at = match pose.cast::<Pose>() {
            Ok(pose) => pose.get().on_host().ok_or_else(|| {
                choice(format!("pose of {name} is on a GPU"), "copy it to the host, or give it to update")
            })?,
            Err(_) => pose_of(&pose)?,
        };
        Ok(Body { body: body.at(at).map_err(raised)? })
    }

    /// Name of the body in messages.
    #[getter]
    fn name(&self) -> &str {
        self.body.name()
    }

    /// Pose at which a rigid body begins; None of other bodies.
    #[getter]
    fn pose(&self, py: Python<'_>) -> PyResult<Option<Pose>> {
        let is_rigid = self.body.kind() == BodyKind::Rigid;
        is_rigid.then(|| Pose::known(py, self.body.poses()[0])).transpose()
    }

    /// Thickness: a radius, or an array of one for each vertex.
    #[getter]
    fn thickness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        thickness::to_python(py, self.body.thickness())
    }

    /// Number of vertices.
    #[getter]
    fn vertex_count(&self) -> usize {
        self.body.vertex_count()
    }

    /// Number of triangles.
    #[getter]
    fn face_count(&self) -> usize {
        self.body.face_count()
    }

    /// Edges, as given: (k, 2) integers.
    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        rows(py, self.body.edges())
    }

    /// Points, as given.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, self.body.points())
    }

    /// For copy and pickle.
    fn __reduce__<'py>(body: &Bound<'py, Self>) -> PyResult<Remade<'py>> {
        let (py, Body { body: own }) = (body.py(), body.get());
        let mesh = (points(py, own.positions_t0()), rows(py, own.faces())).into_pyobject(py)?;
        let (named, meets) = (PyDict::new(py), own.filter());
        let kind = match own.kind() {
            BodyKind::Fixed => "fixed",
            BodyKind::Rigid => "rigid",
            _ => "deformable",
        };
        named.set_item("kind", kind)?;
        named.set_item("self_collision", meets.self_collision)?;
        named.set_item("environment", meets.environment)?;
        named.set_item("group", meets.group)?;
        named.set_item("mask", meets.mask)?;
        named.set_item("name", own.name())?;
        named.set_item("pose", body.getattr("pose")?)?;
        named.set_item("thickness", body.getattr("thickness")?)?;
        for list in ["edges", "points"] {
            let given = body.getattr(list)?;
            if given.len()? > 0 {
                named.set_item(list, given)?;
            }
        }
        remade(body.get_type(), mesh, named)
    }

    fn __repr__(&self) -> String {
        let Body { body } = self;
        format!(
            "<nearmiss.Body {}: {} vertices, {} faces>",
            body.name(),
            body.vertex_count(),
            body.face_count()
        )
    }
}

/// Bodies, numbered from 0 in the order in which they are added.
///
/// - `bodies`: the first bodies.
///
/// A detector takes a copy. From then on, add, remove and replace bodies of the detector.
#[pyclass(module = "nearmiss")]
pub struct Scene {
    pub scene: nearmiss::Scene,
    /// Whether a detector has taken a copy.
    pub taken: bool,
}

impl Scene {
    /// Refuses a change that no detector would see.
    fn is_free(&self, change: &str) -> PyResult<()> {
        if self.taken {
            return Err(choice(
                format!("cannot {change} a scene after a detector has copied it"),
                "change the detector in the same way, or make another Scene",
            ));
        }
        Ok(())
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (*bodies))]
    fn new(bodies: &Bound<'_, PyTuple>) -> PyResult<Scene> {
        let mut scene = nearmiss::Scene::new();
        for body in bodies {
            let Ok(body) = body.cast::<Body>() else {
                let what = format!("bodies must be Body objects, got {}", body.get_type().name()?);
                return Err(choice(what, "use Scene(a, b), or Scene(*bodies)"));
            };
            scene.add(body.get().body.clone());
        }
        Ok(Scene { scene, taken: false })
    }

    /// Add a body, and return its number.
    fn add(&mut self, body: &Body) -> PyResult<usize> {
        self.is_free("add a body to")?;
        Ok(self.scene.add(body.body.clone()).index())
    }

    /// Remove a body, by number or name. The next body that is added may take its number.
    fn remove(&mut self, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<()> {
        self.is_free("remove a body from")?;
        for id in bodies(&self.scene, &[body]).map_err(raised)? {
            self.scene.remove(id);
        }
        Ok(())
    }

    /// Replace the list of pairs of bodies that are not tested against each other, by any query.
    ///
    /// - `pairs`: [(a, b), ...], numbers or names of bodies, as the links of a robot that share a joint.
    ///   Order and repeats do not matter; [] leaves out none.
    ///
    /// A body that is removed takes its pairs with it.
    /// Raises InvalidArgumentError for a body that does not exist, and for a body with itself: then the
    /// list is as before.
    fn leave_out(&mut self, #[pyo3(from_py_with = pairs_of)] pairs: Pairs) -> PyResult<()> {
        self.is_free("leave out pairs of")?;
        let list = key::pairs(&self.scene, &pairs).map_err(raised)?;
        self.scene.leave_out(&list).map_err(raised)
    }

    /// Pairs of bodies that are left out: the smaller number first, ascending.
    #[getter]
    fn left_out(&self) -> Vec<(usize, usize)> {
        numbers(self.scene.left_out())
    }

    /// Replace the exclusions of a body: pairs of its features, and faces that take no part.
    ///
    /// A feature is a vertex, an edge or a face.
    ///
    /// - `ring`: from 1. Two features are left out if at most ring - 1 edges are between a vertex of one
    ///   and a vertex of the other. Ring 1 has pairs with a common vertex. All queries leave
    ///   these out, except Discrete(adjacent=True). Ring 2 also has pairs that an edge joins.
    /// - `within`: a length. Pairs of features that are nearer than this in the rest shape are left out.
    /// - `rest`: the rest shape, an (n, 3) array. Default: the place of the body, at t = 0.
    /// - `faces`: indices of faces that take no part, and with them vertices and edges of no other face.
    ///
    /// exclude(body) alone excludes nothing. All queries obey, except Distance, BodyPairs and
    /// BodyDistances: these raise InvalidArgumentError if there are exclusions. A removed body loses its
    /// exclusions.
    ///
    /// Raises InvalidArgumentError for a body or a face that does not exist, and for a ring of 0. Also for
    /// a length that is negative or not finite, and for a rest shape of another number of vertices.
    /// InputError for vertices that are not finite. Then nothing has changed.
    #[pyo3(signature = (body, *, ring = None, within = None, rest = None, faces = None))]
    fn exclude(
        &mut self,
        #[pyo3(from_py_with = body_of)] body: Key,
        ring: Option<&Bound<'_, PyAny>>,
        within: Option<f64>,
        rest: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.is_free("exclude features of")?;
        let given = exclusions::Given::of(ring, within, rest, faces)?;
        let [id] = key::each(&self.scene, &[body]).map_err(raised)?;
        let own = given.of_body(&self.scene, id);
        self.scene.exclude(id, own).map_err(raised)
    }

    /// Replace the list of pairs of vertices of two bodies whose features are not tested together.
    ///
    /// - `body`, `other`: numbers or names of bodies; they may be the same.
    /// - `pairs`: (n, 2) integers: a vertex of body, and one of other. Order and repeats do not matter; []
    ///   leaves out none. A pair of features is left out if the list has a vertex of each as a pair.
    ///
    /// A body that is removed takes its lists with it.
    ///
    /// Raises InvalidArgumentError for a body or a vertex that does not exist, and for a vertex with
    /// itself. Then the list is as before.
    fn exclude_pairs(
        &mut self,
        #[pyo3(from_py_with = body_of)] body: Key,
        #[pyo3(from_py_with = body_of)] other: Key,
        pairs: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.is_free("exclude features of")?;
        let list = exclusions::pairs(pairs)?;
        let ids = key::each(&self.scene, &[body, other]).map_err(raised)?;
        self.scene.exclude_pairs(ids, &list).map_err(raised)
    }

    /// Pairs of vertices of two bodies that are left out, as an (n, 2) array, ascending.
    fn excluded_pairs<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = body_of)] body: Key,
        #[pyo3(from_py_with = body_of)] other: Key,
    ) -> PyResult<Bound<'py, numpy::PyArray2<u32>>> {
        let ids = key::each(&self.scene, &[body, other]).map_err(raised)?;
        Ok(rows(py, &self.scene.excluded_pairs(ids)))
    }

    /// Return the number of the one body with that name: scene[name] is the same.
    ///
    /// Raises InvalidArgumentError if no body has the name, or several have; it lists them.
    fn id(&self, name: &str) -> PyResult<usize> {
        self.scene.id_of(name).map(|id| id.index()).map_err(raised)
    }

    fn __getitem__(&self, name: &str) -> PyResult<usize> {
        self.id(name)
    }

    /// Numbers of all bodies, ascending.
    #[getter]
    fn bodies(&self) -> Vec<usize> {
        self.scene.ids().map(|id| id.index()).collect()
    }

    fn __len__(&self) -> usize {
        self.scene.ids().count()
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Scene of {}>", counted(self.__len__() as u64, "body", "bodies"))
    }
}

/// The scene of a detector.
pub fn scene_of(given: &Bound<'_, PyAny>) -> PyResult<nearmiss::Scene> {
    if let Ok(body) = given.cast::<Body>() {
        return Ok(nearmiss::Scene::from(body.get().body.clone()));
    }
    if let Ok(scene) = given.cast::<Scene>() {
        return Ok(scene.borrow().scene.clone());
    }
    Err(choice(
        format!("scene must be a Scene or a Body, got {}", given.get_type().name()?),
        "use Detector(Scene(*bodies))",
    ))
}
