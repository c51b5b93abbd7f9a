//! glTF and GLB files to positions and faces: all meshes of the scene, where its nodes place them.
//!
//! The crate `gltf` reads the JSON and checks its references. Numbers of accessors are read here,
//! within the bounds of their buffers.

mod data;

use crate::loose::Loose;
use crate::mesh_file::Parsed;
use crate::note::{Notes, Treated};
use crate::polygons::Fans;
use crate::problems::wrong;
use crate::welded::{Welded, positions};
use ::gltf::json::validation::Checked;
use ::gltf::mesh::Mode;
use ::gltf::{Document, Gltf, Node, Primitive, Semantic};
use data::Data;
use nearmiss::mesh::Problem;
use nearmiss::{Error, memory};
use std::collections::HashSet;

/// Most bytes of memory that a byte of the JSON takes: empty nodes take most.
const OF_JSON: u64 = 512;

/// Most bytes of memory that a corner takes while it is welded.
const OF_A_CORNER: u64 = 200;

/// The extension by which a node has more meshes than are read.
const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// Other files that a file names, by their path from it.
pub(crate) type Others<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, Problem>;

/// The columns of a matrix that places a mesh; `None` where it is.
type Placed = Option<[[f64; 4]; 4]>;

/// Checks that memory suffices for the JSON of a file.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn require(name: &str, bytes: &[u8]) -> Result<(), Error> {
    let json = match bytes {
        [b'g', b'l', b'T', b'F', _, _, _, _, _, _, _, _, a, b, c, d, ..] => {
            u64::from(u32::from_le_bytes([*a, *b, *c, *d])).min(bytes.len() as u64)
        }
        _ => bytes.len() as u64,
    };
    memory::require(&format!("reading {name}"), json * OF_JSON)
}

/// Reads the whole file.
pub(crate) fn read(bytes: &[u8], others: Others<'_>) -> Result<Parsed, Problem> {
    if bytes.starts_with(b"glTF") {
        let length =
            bytes.get(8..12).map_or(0, |four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]));
        if length < 12 || length as usize > bytes.len() {
            let what = format!("has {length} bytes by its header, and is {} long", bytes.len());
            return Err(wrong(what, "copy the file again"));
        }
    }
    let file = checked(bytes)?;
    let mut notes = Notes::default();
    if file.extensions_used().any(|name| name == INSTANCES) {
        notes
            .add(Treated::NotRead, || wrong(format!("{INSTANCES} is not supported"), "export each instance"));
    }
    let mut all = Reader {
        data: Data::new(&file, others),
        welded: Welded::default(),
        fans: Fans::default(),
        loose: Loose::default(),
        notes,
        moved: 0,
        other_scenes: 0,
    };
    match file.default_scene().or_else(|| file.scenes().next()) {
        Some(scene) => {
            let others = file.scenes().filter(|other| other.index() != scene.index());
            all.other_scenes = others.filter(|other| other.nodes().len() > 0).count() as u64;
            all.nodes(scene.nodes().collect(), file.nodes().len())?;
        }
        // A file without scenes has trees of nodes all the same, or meshes alone.
        None if file.nodes().len() > 0 => {
            let below: HashSet<usize> =
                file.nodes().flat_map(|node| node.children()).map(|node| node.index()).collect();
            let roots = file.nodes().filter(|node| !below.contains(&node.index()));
            let visited = all.nodes(roots.collect(), file.nodes().len())?;
            if visited < file.nodes().len() {
                return Err(wrong("has nodes that are below themselves", "give each node one parent"));
            }
        }
        None => file.meshes().try_for_each(|mesh| {
            all.welded.part();
            mesh.primitives().try_for_each(|primitive| all.primitive(&primitive, None, mesh.index()))
        })?,
    }
    all.finish()
}

/// The JSON of a file, with its references checked. The crate looks up positions before it checks
/// their references, so these come first.
fn checked(bytes: &[u8]) -> Result<Gltf, Problem> {
    let refused = |e| wrong(format!("is no glTF that is read: {e}"), "export it again, without compression");
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(refused)?;
    let json = document.into_json();
    let (positions, count) = (Checked::Valid(Semantic::Positions), json.accessors.len());
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut used = primitives.filter_map(|primitive| primitive.attributes.get(&positions));
    if let Some(index) = used.find(|index| index.value() >= count) {
        let what = format!("names accessor {}, but there are {count}", index.value());
        return Err(wrong(what, "copy the file again, or export it again"));
    }
    Ok(Gltf { document: Document::from_json(json).map_err(refused)?, blob })
}

/// A file while it is read.
struct Reader<'a> {
    data: Data<'a>,
    welded: Welded,
    fans: Fans,
    loose: Loose,
    notes: Notes,
    /// Meshes that a bone or a morph target moves.
    moved: u64,
    /// Scenes besides the one that is read.
    other_scenes: u64,
}

impl Reader<'_> {
    /// All meshes of a scene; returns the number of its nodes. A node has one parent at most, so each
    /// is visited once.
    fn nodes(&mut self, roots: Vec<Node<'_>>, count: usize) -> Result<usize, Problem> {
        let mut visited = vec![false; count];
        let mut next: Vec<(Node, Placed)> = roots.into_iter().rev().map(|node| (node, None)).collect();
        while let Some((node, parent)) = next.pop() {
            if std::mem::replace(&mut visited[node.index()], true) {
                let what = format!("node {} has two parents, or is its own", node.index());
                return Err(wrong(what, "give each node one parent"));
            }
            let placed = placed(parent, node.transform().matrix());
            if let Some(mesh) = node.mesh() {
                let is_moved =
                    node.skin().is_some() || mesh.primitives().any(|p| p.morph_targets().len() > 0);
                self.moved += u64::from(is_moved);
                self.welded.part();
                for primitive in mesh.primitives() {
                    self.primitive(&primitive, placed, mesh.index())?;
                }
            }
            let children: Vec<Node> = node.children().collect();
            next.extend(children.into_iter().rev().map(|node| (node, placed)));
        }
        Ok(visited.into_iter().filter(|is_visited| *is_visited).count())
    }

    fn primitive(&mut self, primitive: &Primitive<'_>, placed: Placed, mesh: usize) -> Result<(), Problem> {
        let called = format!("mesh {mesh}, primitive {}", primitive.index());
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            self.notes.add(Treated::NotRead, || wrong(format!("{called}: has no positions"), "add POSITION"));
            return Ok(());
        };
        let points = self.data.points(&accessor, &called)?;
        let indices = match primitive.indices() {
            Some(accessor) => self.data.indices(&accessor, &called)?,
            None => (0..points.len() as u32).collect(),
        };
        // Nodes may place a mesh any number of times.
        let bytes = (self.welded.corners + indices.len() as u64).saturating_mul(OF_A_CORNER);
        memory::require("the meshes of its nodes", bytes)
            .map_err(|e| wrong(format!("places too many meshes: {e}"), "export fewer instances"))?;
        let least = match primitive.mode() {
            Mode::TriangleStrip | Mode::TriangleFan => 3,
            Mode::LineStrip | Mode::LineLoop => 2,
            Mode::Points | Mode::Lines | Mode::Triangles => 0,
        };
        if indices.len() < least {
            let found = indices.len();
            self.notes.add(Treated::NotRead, || {
                wrong(
                    format!("{called}: has {found} corners, and needs {least}"),
                    "add corners, or remove it",
                )
            });
        }
        let mut corners = Vec::with_capacity(indices.len());
        for index in indices {
            let point = points.get(index as usize).ok_or_else(|| {
                let count = points.len();
                wrong(format!("{called}: names vertex {index}, but there are {count}"), "export it again")
            })?;
            corners.push(self.welded.corner(place(placed, *point)));
        }
        let (fans, loose) = (&mut self.fans, &mut self.loose);
        match primitive.mode() {
            Mode::Triangles => {
                whole(corners.len(), 3, "triangles have three", &called)?;
                corners.chunks_exact(3).for_each(|c| fans.single([c[0], c[1], c[2]]));
            }
            Mode::TriangleStrip => corners.windows(3).enumerate().for_each(|(at, c)| {
                fans.of_strip([c[0], c[1], c[2]], at % 2 == 1);
            }),
            Mode::TriangleFan => {
                if let Some((&first, rest)) = corners.split_first() {
                    rest.windows(2).for_each(|c| fans.of_strip([first, c[0], c[1]], false));
                }
            }
            Mode::Points => corners.iter().for_each(|&vertex| loose.point(vertex)),
            Mode::Lines => {
                whole(corners.len(), 2, "lines have two", &called)?;
                corners.chunks_exact(2).for_each(|c| loose.segment([c[0], c[1]]));
            }
            mode @ (Mode::LineStrip | Mode::LineLoop) => {
                corners.windows(2).for_each(|c| loose.segment([c[0], c[1]]));
                if let (Mode::LineLoop, [first, .., last]) = (mode, &corners[..]) {
                    loose.segment([*last, *first]);
                }
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Parsed, Problem> {
        let (corners, vertices) = (self.welded.corners, self.welded.points.len() as u64);
        if corners > 0 {
            self.notes.add_many(Treated::Welded { vertices }, corners, || {
                wrong(
                    "a glTF file has a vertex for each of its normals",
                    "give a PLY or OBJ file to keep seams open",
                )
            });
        }
        if self.other_scenes > 0 {
            self.notes.add_many(Treated::NotRead, self.other_scenes, || {
                wrong("the file has several scenes, and the default one is read", "export one scene")
            });
        }
        if self.moved > 0 {
            self.notes.add_many(Treated::NotRead, self.moved, || {
                wrong("skins and morph targets move a mesh, which is read at rest", "export the posed mesh")
            });
        }
        let positions = positions(self.welded.points);
        Ok(Parsed { positions, fans: self.fans, loose: self.loose, notes: self.notes })
    }
}

/// Refuses corners that do not make whole triangles or lines.
fn whole(corners: usize, each: usize, what: &str, called: &str) -> Result<(), Problem> {
    if corners.is_multiple_of(each) {
        return Ok(());
    }
    Err(wrong(format!("{called}: has {corners} corners, and {what} each"), "export it again"))
}

/// The matrix of a node below another.
fn placed(parent: Placed, own: [[f32; 4]; 4]) -> Placed {
    let own = own.map(|column| column.map(f64::from));
    let is_unit = (0..4).all(|c| (0..4).all(|r| own[c][r] == f64::from(u8::from(c == r))));
    match (parent, is_unit) {
        (parent, true) => parent,
        (None, false) => Some(own),
        (Some(parent), false) => {
            Some(own.map(|column| [0, 1, 2, 3].map(|row| (0..4).map(|k| parent[k][row] * column[k]).sum())))
        }
    }
}

/// A point where a matrix places it, in doubles.
fn place(placed: Placed, point: [f64; 3]) -> [f64; 3] {
    placed
        .map_or(point, |m| [0, 1, 2].map(|row| (0..3).map(|k| m[k][row] * point[k]).sum::<f64>() + m[3][row]))
}
