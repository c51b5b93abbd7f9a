//! `nearmiss-peer-parry A.ply B.ply REPEAT`: distance of two meshes by parry3d and its time, in f32
//! and in f64: one line of JSON each. The files are those of `scenes.py`.

use std::time::Instant;

/// The mesh of a file.
struct Mesh {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

fn read(path: &str) -> Mesh {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let mark = b"end_header\n";
    let end = bytes.windows(mark.len()).position(|w| w == mark).expect("a header that ends") + mark.len();
    let header = std::str::from_utf8(&bytes[..end]).expect("a header of text");
    let count = |name: &str| -> usize {
        let line = header.lines().find_map(|line| line.strip_prefix(name)).expect("its counts");
        line.trim().parse().expect("a number")
    };
    let (vertices, triangles) = bytes[end..].split_at(12 * count("element vertex"));
    let word = |b: &[u8], at: usize| [b[at], b[at + 1], b[at + 2], b[at + 3]];
    let rows = triangles.chunks_exact(13).take(count("element face"));
    Mesh {
        vertices: vertices.chunks_exact(12).map(|b| [0, 4, 8].map(|at| f32::from_le_bytes(word(b, at)))).collect(),
        triangles: rows.map(|b| [1, 5, 9].map(|at| u32::from_le_bytes(word(b, at)))).collect(),
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The same measurement for both crates.
macro_rules! measure {
    ($parry:ident, $real:ty, $name:literal, $meshes:expr, $repeat:expr) => {{
        use $parry::{math::{Pose, Vector}, query, shape::TriMesh};
        let make = |mesh: &Mesh| {
            let place = |v: &[f32; 3]| Vector::new(v[0] as $real, v[1] as $real, v[2] as $real);
            TriMesh::new(mesh.vertices.iter().map(place).collect(), mesh.triangles.clone()).expect("triangles")
        };
        let started = Instant::now();
        let [a, b] = $meshes.each_ref().map(make);
        let build = milliseconds(started);
        let here = Pose::IDENTITY;
        let mut distance = <$real>::NAN;
        let run = |_| {
            let started = Instant::now();
            distance = query::distance(&here, &a, &here, &b).expect("meshes are supported").distance;
            milliseconds(started)
        };
        let query = median((0..$repeat).map(run).collect());
        let line = serde_json::json!({ "name": $name, "distance": f64::from(distance), "build": build, "query": query });
        println!("{line}");
    }};
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [a, b, repeat] = &args[..] else { panic!("three arguments: A.ply B.ply REPEAT") };
    let repeat: usize = repeat.parse().expect("REPEAT is a number");
    let meshes = [read(a), read(b)];
    measure!(parry3d, f32, "parry3d, f32", meshes, repeat);
    measure!(parry3d_f64, f64, "parry3d, f64", meshes, repeat);
}
