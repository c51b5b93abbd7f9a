//! PLY files to positions and faces.
//!
//! This is our own reader. Other crates allocate by the counts in the header, and a damaged file
//! may have counts of any size. Or they lose the number of the bad element.

use super::header::{Element, Encoding, Header, Kind, Property, is_corners};
use super::source::{Failure, Scalar, Source, Value};
use crate::loose::Loose;
use crate::mesh_file::Parsed;
use crate::note::{Notes, Treated};
use crate::polygons::Fans;
use crate::problems::{Problems, wrong};
use crate::shown::shown;
use nearmiss::mesh::{MAX_FACES, MAX_VERTICES, PlyProblem, Positions, Problem};

/// Elements without surfaces that scanners and modellers write; they are skipped without a note.
const QUIET: [&str; 4] = ["material", "camera", "user", "range_grid"];

/// Reads the whole file; faces keep the file's order.
pub(crate) fn read(bytes: &[u8], problems: &mut Problems) -> Result<Parsed, Problem> {
    let header = Header::read(bytes)?;
    let vertex = header.elements.iter().find(|e| e.name == "vertex").ok_or(PlyProblem::NoVertices)?;
    let mut source = Source::new(&bytes[header.size..], header.encoding);
    let mut positions = Positions::F32(Vec::new());
    let (mut fans, mut loose, mut notes) = (Fans::default(), Loose::default(), Notes::default());
    for element in &header.elements {
        promise(element, &source)?;
        match element.name {
            "vertex" => positions = vertices(element, &mut source)?,
            "face" => polygons(element, vertex.count, &mut source, (&mut fans, &mut notes, problems))?,
            "tristrips" => strips(element, vertex.count, &mut source, (&mut fans, &mut notes, problems))?,
            "edge" if ends(element).is_some() => {
                edges(element, vertex.count, &mut source, (&mut loose, problems))?;
            }
            _ if element.properties.is_empty() => {} // any number of entries, no room
            name => {
                entries(element, &mut source, |_, _, _, _| Ok(()))?;
                if !QUIET.contains(&name) && element.count > 0 {
                    let name = shown(name.as_bytes());
                    let first = || PlyProblem::Unread { element: name, count: element.count }.into();
                    notes.add_many(Treated::NotRead, element.count, first);
                }
            }
        }
    }
    source.begin_entry();
    match (source.left(), header.encoding) {
        (0, _) => Ok(Parsed { positions, fans, loose, notes }),
        (_, Encoding::Ascii) => Err(PlyProblem::TrailingText { found: shown(source.end_entry()) }.into()),
        (bytes, _) => Err(PlyProblem::Trailing { bytes }.into()),
    }
}

/// Refuses a count that exceeds the rest of the file, so that its elements may be allocated.
fn promise(element: &Element<'_>, source: &Source<'_>) -> Result<(), PlyProblem> {
    let least = |p: &Property<'_>| match p.kind {
        Kind::One(scalar) | Kind::List { length: scalar, .. } => u128::from(source.least(scalar)),
    };
    let need = u128::from(element.count) * element.properties.iter().map(least).sum::<u128>();
    if source.holds(need) {
        return Ok(());
    }
    let element_name = shown(element.name.as_bytes());
    Err(PlyProblem::Promise { element: element_name, count: element.count, need, left: source.left() })
}

fn vertices(element: &Element<'_>, source: &mut Source<'_>) -> Result<Positions, Problem> {
    within("vertices", element.count, MAX_VERTICES)?;
    let mut single = true;
    let mut columns = [0; 3];
    for (column, axis) in columns.iter_mut().zip(['x', 'y', 'z']) {
        let named = |p: &Property<'_>| p.name.len() == 1 && p.name.starts_with(axis);
        *column = element.properties.iter().position(named).ok_or(PlyProblem::NoCoordinate { axis })?;
        match element.properties[*column].kind {
            Kind::One(scalar) => single &= scalar.fits_f32(),
            Kind::List { .. } => return Err(PlyProblem::ListCoordinate { axis }.into()),
        }
    }
    if single {
        Ok(Positions::F32(coordinates(element, source, columns, to_f32)?))
    } else {
        Ok(Positions::F64(coordinates(element, source, columns, to_f64)?))
    }
}

fn coordinates<T: Copy + Default>(
    element: &Element<'_>,
    source: &mut Source<'_>,
    columns: [usize; 3],
    convert: fn(Value) -> T,
) -> Result<Vec<[T; 3]>, Problem> {
    let mut points = Vec::with_capacity(element.count as usize); // the file holds as many: see `promise`
    entries(element, source, |index, column, _, value| {
        if points.len() as u64 == index {
            points.push([T::default(); 3]);
        }
        if let (Some(axis), Some(point)) = (columns.iter().position(|&c| c == column), points.last_mut()) {
            point[axis] = convert(value);
        }
        Ok(())
    })?;
    Ok(points)
}

/// Exact: used only if every column fits (`Scalar::fits_f32`).
fn to_f32(value: Value) -> f32 {
    match value {
        Value::Int(i) => i as f32,
        Value::F32(x) => x,
        Value::F64(x) => x as f32,
    }
}

/// Exact: whole numbers of PLY have at most 32 bits.
fn to_f64(value: Value) -> f64 {
    match value {
        Value::Int(i) => i as f64,
        Value::F32(x) => x.into(),
        Value::F64(x) => x,
    }
}

/// The column of the corners of an element.
fn corners(element: &Element<'_>) -> Result<usize, PlyProblem> {
    let mut lists = element.properties.iter().enumerate().filter(|(_, p)| is_corners(p.name));
    match (lists.next(), lists.next()) {
        (Some((column, Property { kind: Kind::List { .. }, .. })), None) => Ok(column),
        (Some(_), Some(_)) => Err(PlyProblem::TwoCorners),
        _ => Err(PlyProblem::NoCorners),
    }
}

/// The fault of an index of a vertex, if it has one.
fn index_fault(face: u64, corner: u64, index: i64, vertices: u64) -> Option<PlyProblem> {
    match index {
        ..0 => Some(PlyProblem::NegativeIndex { face, corner, index }),
        _ if index as u64 >= vertices => Some(PlyProblem::Index { face, corner, index, vertices }),
        _ => None,
    }
}

/// The columns of both ends of an edge.
fn ends(element: &Element<'_>) -> Option<[usize; 2]> {
    let column = |name: &str| {
        let is_end = |p: &Property<'_>| p.name == name && matches!(p.kind, Kind::One(of) if of.is_integer());
        element.properties.iter().position(is_end)
    };
    Some([column("vertex1")?, column("vertex2")?])
}

/// Reads edges. One between a vertex and itself is a point.
fn edges(
    element: &Element<'_>,
    vertices: u64,
    source: &mut Source<'_>,
    (loose, problems): (&mut Loose, &mut Problems),
) -> Result<(), Problem> {
    within("edges", element.count, MAX_FACES)?;
    let columns = ends(element).unwrap_or_default();
    let last = columns[0].max(columns[1]);
    let mut pair = [0; 2];
    entries(element, source, |edge, at, _, value| {
        let (Some(end), Value::Int(index)) = (columns.iter().position(|&column| column == at), value) else {
            return Ok(());
        };
        pair[end] = match u32::try_from(index).ok().filter(|&vertex| u64::from(vertex) < vertices) {
            Some(vertex) => vertex,
            None => problems.add(PlyProblem::End { edge, index, vertices }).map(|()| 0)?,
        };
        if at == last {
            loose.segment(pair);
        }
        Ok(())
    })
}

/// Reads strips of triangles; -1 ends one and begins the next.
fn strips(
    element: &Element<'_>,
    vertices: u64,
    source: &mut Source<'_>,
    (faces, notes, problems): (&mut Fans, &mut Notes, &mut Problems),
) -> Result<(), Problem> {
    let column = corners(element)?;
    let (mut last, mut turned) = ([None; 2], false);
    let (mut length, mut strips) = (0, 0);
    // The end of a strip of so many vertices.
    let mut end = |length: u64| {
        if matches!(length, 1 | 2) {
            let what = format!("strip {strips} has {length} of the three vertices of a triangle");
            notes.add(Treated::NotRead, || wrong(what, "remove it, or add vertices"));
        }
        strips += u64::from(length > 0);
    };
    entries(element, source, |strip, at, item, value| {
        match (item, value) {
            _ if at != column => {}
            (Item::Length, _) | (Item::At(_), Value::Int(-1)) => {
                end(std::mem::take(&mut length));
                (last, turned) = ([None; 2], false);
            }
            (Item::At(corner), Value::Int(index)) => {
                if let Some(problem) = index_fault(strip, corner, index, vertices) {
                    return problems.add(problem);
                }
                length += 1;
                let vertex = index as u32;
                if let [Some(a), Some(b)] = last {
                    faces.of_strip([a, b, vertex], turned);
                    turned = !turned;
                }
                last = [last[1], Some(vertex)];
            }
            _ => {}
        }
        Ok(())
    })?;
    end(length);
    within("triangles", faces.faces.len() as u64, MAX_FACES)
}

fn polygons(
    element: &Element<'_>,
    vertices: u64,
    source: &mut Source<'_>,
    (faces, notes, problems): (&mut Fans, &mut Notes, &mut Problems),
) -> Result<(), Problem> {
    let column = corners(element)?;
    faces.faces.reserve(element.count as usize); // see `promise`
    let mut corners = 0;
    entries(element, source, |face, at, item, value| {
        let Value::Int(index) = value else { return Ok(()) };
        match item {
            _ if at != column => return Ok(()),
            Item::Length => {
                corners = index as u64; // not negative: see `Place::length`
                if corners == 0 {
                    faces.leave_out(corners);
                }
                if corners < 3 {
                    notes.add(Treated::LeftOut, || PlyProblem::Corners { face, corners }.into());
                }
            }
            Item::At(corner) => {
                // A corner stays a corner even if it is wrong.
                let index = match index_fault(face, corner, index, vertices) {
                    Some(problem) => problems.add(problem).map(|()| 0)?,
                    None => index,
                };
                faces.corner(corner, index as u32); // below 2^32, as every whole number of PLY
                if corners < 3 && corner + 1 == corners {
                    faces.leave_out(corners);
                }
            }
            Item::Only => {}
        }
        Ok(())
    })?;
    within("triangles", faces.faces.len() as u64, MAX_FACES)
}

/// Refuses a count that exceeds a mesh's limit, before there is a mesh.
fn within(what: &'static str, count: u64, limit: usize) -> Result<(), Problem> {
    let limit = limit as u64;
    if count > limit { Err(Problem::TooMany { what, count, limit }) } else { Ok(()) }
}

/// The part of a property that a value is.
#[derive(Clone, Copy)]
enum Item {
    Only,
    Length,
    At(u64),
}

/// Reads all entries of an element; `each` gets the entry, the property's column, the part and the
/// value.
fn entries(
    element: &Element<'_>,
    source: &mut Source<'_>,
    mut each: impl FnMut(u64, usize, Item, Value) -> Result<(), Problem>,
) -> Result<(), Problem> {
    for index in 0..element.count {
        source.begin_entry();
        for (column, property) in element.properties.iter().enumerate() {
            let place = Place { element, index, property };
            match property.kind {
                Kind::One(scalar) => each(index, column, Item::Only, place.next(source, scalar)?)?,
                Kind::List { length, item } => {
                    let count = place.length(source, length, item)?;
                    each(index, column, Item::Length, Value::Int(count as i64))?;
                    for i in 0..count {
                        each(index, column, Item::At(i), place.next(source, item)?)?;
                    }
                }
            }
        }
        let extra = source.end_entry();
        if !extra.is_empty() {
            let element = shown(element.name.as_bytes());
            return Err(PlyProblem::LongLine { element, index, found: shown(extra) }.into());
        }
    }
    Ok(())
}

/// The place of a value in the file, for messages.
struct Place<'a> {
    element: &'a Element<'a>,
    index: u64,
    property: &'a Property<'a>,
}

impl Place<'_> {
    fn names(&self) -> (String, u64, String) {
        (shown(self.element.name.as_bytes()), self.index, shown(self.property.name.as_bytes()))
    }

    fn next(&self, source: &mut Source<'_>, scalar: Scalar) -> Result<Value, PlyProblem> {
        source.next(scalar).map_err(|failure| {
            let (element, index, property) = self.names();
            match failure {
                Failure::End => PlyProblem::Cut { element, index, property },
                Failure::LineEnd => PlyProblem::ShortLine { element, index, property },
                Failure::Token(token) => {
                    PlyProblem::Number { element, index, property, found: shown(token), kind: scalar.name() }
                }
            }
        })
    }

    /// The length of a list; refused if its items exceed the rest of the file.
    fn length(&self, source: &mut Source<'_>, length: Scalar, item: Scalar) -> Result<u64, PlyProblem> {
        let Value::Int(found) = self.next(source, length)? else { return Ok(0) }; // the header admits no other type
        let Ok(length) = u64::try_from(found) else {
            let (element, index, property) = self.names();
            return Err(PlyProblem::NegativeLength { element, index, property, found });
        };
        let need = u128::from(length) * u128::from(source.least(item));
        if source.holds(need) {
            return Ok(length);
        }
        let (element, index, property) = self.names();
        Err(PlyProblem::Length { element, index, property, length, need, left: source.left() })
    }
}
