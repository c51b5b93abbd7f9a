//! Every constant of `tolerance.rs` and of the folder `tolerance` is measured by a test of its name, or is listed here with why not.

use std::path::Path;

/// Constants on which no proof of an answer rests, or which are no allowance.
const OTHERS: [(&str, &str); 49] = [
    ("U32", "the unit"),
    ("U64", "the unit"),
    ("CUBIC_VALUE", "a guess: the cubic's roots guarantee nothing"),
    ("CUBIC_INSIDE", "a guess"),
    ("PARALLEL", "a guess"),
    ("CUBIC_SCALE", "a range"),
    ("INCLUSION_FINEST", "a limit of what may be asked"),
    ("INCLUSION_FAINT", "a range"),
    ("ISOLATE_MARGIN", "a cost"),
    ("HORIZON_MARGIN", "the sum of ISOLATE_MARGIN and two windows, and more: tests/kernels/isolate/begin.rs"),
    ("ADVANCE_FINEST", "a limit of what may be asked"),
    ("NEAR_FINEST", "a limit of what may be asked"),
    ("NEAR_GROWTH", "what is listed, not what is certain"),
    ("DISTANCE_ERROR", "rounded up for nothing: `the_error_of_a_distance` measures it to a sixtieth"),
    ("DISTANCE_LISTED", "the sum of DISTANCE_ERROR and DISTANCE_CERTAIN, and more"),
    ("DISTANCE_TIED", "which points count as nearest: twice DISTANCE_ERROR, and more"),
    ("DISTANCE_WEIGHT", "rounded up for nothing: `the_error_of_a_parameter` measures it to a sixtieth"),
    ("DISTANCE_SMALL", "a range"),
    ("DISTANCE_SCALE", "a power of two, exact"),
    ("DISTANCE_FILTERED", "a range"),
    ("INCLUSION_SHRUNK", "a cost"),
    ("INCLUSION_FLAT", "a cost"),
    ("INCLUSION_DEEP", "a cost"),
    ("MOVING_LIMIT", "a range"),
    ("BOX_LIMIT", "a range"),
    ("DIRECTION", "ten differences count where three err: tests/kernels/direction.rs needs it"),
    ("COVARIANCE_ZERO", "a cost: any axes are valid"),
    ("SINGLE_MOST", "a range: within it f32 overflows nowhere"),
    (
        "SWEPT_ROUNDED",
        "one rounding of a difference, as in INCLUSION_INPUT: tests/kernels/sweep.rs loses none",
    ),
    ("POSE_UNIT", "a range of what is taken for a pose"),
    ("RELATIVE_LIMIT", "a range"),
    ("PLANE_LIMIT", "a range"),
    ("TILE_SLACK", "the root of 3, rounded up, of RELATIVE_SLACK: tests of bvh/tile_box.rs need a hundredth"),
    ("TILE_BOX", "`roundings_of_a_gap` of bvh/tile_box.rs measures it"),
    ("TILE_EXTENT", "roundings of f64, a millionth of TILE_BOX: no test can need them"),
    ("TURN_FAINT", "a range"),
    ("TURN_MOST", "a range"),
    ("TURNING_FAINT", "a range"),
    ("TURNING_FINEST", "a limit of what may be asked"),
    ("TURNING_SHORTEST", "a cost"),
    ("TURNING_NEAR", "a cost"),
    ("TURNING_ACROSS", "a cost"),
    ("TURNING_SINGLE", "sixteen roundings where ten are needed: tests/kernels/turning_apart.rs needs it"),
    ("TURNING_SINGLE_UP", "rounds what is needed upward, sixteen roundings where seven are needed"),
    ("TURNING_SINGLE_FAINT", "a range"),
    ("SWELL", "what is listed, and 65,536 roundings where placing a vertex takes 40: tests/kernels/swell.rs"),
    ("SWELL_UP", "rounds to f32 upward: tests/kernels/swell.rs"),
    ("BALL", "what is left out, 8 million roundings where lengths and turns take 100: prim/balls.rs"),
    ("PLACED_BOX", "rounded up for nothing: `the_error_of_a_placed_box` measures it"),
];

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The names of all constants, once each.
fn constants(text: &str) -> Vec<&str> {
    let mut all: Vec<&str> = text
        .lines()
        .filter_map(|line| line.trim_start().trim_start_matches("pub ").strip_prefix("const "))
        .filter_map(|rest| rest.split(':').next())
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Constants that are in neither list or in both, and names of the list that are no constants.
fn undeclared(tolerance: &str, tests: &str) -> Vec<String> {
    let all = constants(tolerance);
    let measured = |name: &str| tests.contains(&format!("#[test]\nfn {}()", name.to_lowercase()));
    let listed = |name: &str| OTHERS.iter().any(|(other, _)| *other == name);
    let one = |name: &&str| match (measured(name), listed(name)) {
        (false, false) => Some(format!("{name} has no measure: give it a test, or say why it needs none")),
        (true, true) => Some(format!("{name} is measured and listed as if it were not")),
        _ => None,
    };
    let gone = OTHERS.iter().filter(|(name, _)| !all.contains(name));
    all.iter().filter_map(one).chain(gone.map(|(name, _)| format!("{name} is no constant"))).collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn tolerance() -> String {
    let files = ["tolerance.rs", "tolerance/swell.rs", "tolerance/turning.rs"];
    files.iter().map(|file| read(&root().join("kernels/src/math").join(file))).collect()
}

fn tests() -> String {
    let folder = root().join("tests/kernels/bounds");
    let mut files: Vec<_> =
        std::fs::read_dir(&folder).expect("a folder").flatten().map(|f| f.path()).collect();
    files.sort();
    files.iter().map(|path| read(path)).collect()
}

#[test]
fn every_constant_is_declared() {
    assert_eq!(undeclared(&tolerance(), &tests()), [""; 0]);
}

#[test]
fn an_undeclared_constant_is_noticed() {
    let (tolerance, tests) = (tolerance(), tests());
    let with = |line: &str| undeclared(&format!("{tolerance}\n{line}"), &tests);
    for line in ["pub const NEW_BOUND: f32 = 1.0;", "    const NEW_BOUND: Self;"] {
        assert_eq!(with(line), ["NEW_BOUND has no measure: give it a test, or say why it needs none"]);
    }
    let without = tests.replace("fn box_point()", "fn box_points()");
    assert!(undeclared(&tolerance, &without)[0].starts_with("BOX_POINT has no measure"));
    let both = format!("{tests}\n#[test]\nfn box_limit()");
    assert!(undeclared(&tolerance, &both)[0].starts_with("BOX_LIMIT is measured"));
    assert!(undeclared(&tolerance.replace("PARALLEL:", "LEVEL:"), &tests).len() == 2);
}
