//! The committed header is made from the sources: `NEARMISS_BLESS=1 cargo test -p nearmiss-c --test header`
//! writes it. `c/abi.txt` lists the layout of the header. It changes with `NEARMISS_ABI` alone.

mod layout;

use layout::{Layout, Shape, compared};
use nearmiss_c::*;
use std::path::Path;

fn is_blessing() -> bool {
    std::env::var_os("NEARMISS_BLESS").is_some()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The header that the sources make.
fn made() -> String {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).expect("a configuration");
    let made = cbindgen::Builder::new().with_crate(root()).with_config(config).generate().expect("a header");
    let mut text = Vec::new();
    made.write(&mut text);
    String::from_utf8(text).expect("UTF-8")
}

#[test]
fn the_header_is_that_of_the_sources() {
    let (path, text) = (root().join("include/nearmiss.h"), made());
    if is_blessing() {
        std::fs::write(&path, &text).expect("written");
    }
    let committed = std::fs::read_to_string(&path).expect("a header");
    assert!(committed == text, "include/nearmiss.h is old: bless it, and look at what changed");
}

/// Blessing writes the list of a new number, never another list of the same number.
#[test]
fn a_layout_changes_with_its_number_alone() {
    let (path, layout) = (root().join("abi.txt"), Layout::of(&made()));
    assert_eq!(layout.abi, NEARMISS_ABI);
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(compared(&layout, &committed), Ok(()));
    if is_blessing() {
        std::fs::write(&path, layout.list()).expect("written");
    }
    let committed = std::fs::read_to_string(&path).expect("c/abi.txt");
    assert!(committed == layout.list(), "c/abi.txt is of an earlier NEARMISS_ABI: bless it");
}

#[test]
fn a_changed_layout_without_a_new_number_is_named() {
    let header = made();
    let committed = Layout::of(&header).list();
    let planted = [
        // A field more.
        ("    uint64_t slices;", "    uint64_t slices;\n    uint64_t more;", "struct NearmissSummary size"),
        // A field of another name.
        ("    uint32_t feature_a;", "    uint32_t z;", "field NearmissContact.feature_a offset"),
        // A wider type.
        ("    uint32_t length;", "    uint64_t length;", "struct NearmissError size"),
        // A longer array.
        ("#define NEARMISS_TEXT 1016", "#define NEARMISS_TEXT 1024", "struct NearmissError size"),
        // Another value.
        ("NEARMISS_VF = 0", "NEARMISS_VF = 7", "value NearmissKind NEARMISS_VF 0"),
        // A function takes more.
        ("nearmiss_exit_code(uint32_t code)", "nearmiss_exit_code(uint64_t code)", "nearmiss_exit_code"),
    ];
    for (from, to, named) in planted {
        let other = header.replace(from, to);
        assert!(other != header, "{from} is not in the header");
        let text = compared(&Layout::of(&other), &committed).expect_err(to);
        assert!(text.contains(named) && text.contains("raise NEARMISS_ABI"), "{to}: {text}");
        let number = format!("#define NEARMISS_ABI {NEARMISS_ABI}");
        assert!(other.contains(&number));
        let raised = other.replace(&number, &format!("#define NEARMISS_ABI {}", NEARMISS_ABI + 1));
        assert_eq!(compared(&Layout::of(&raised), &committed), Ok(()), "{to}, with a new number");
    }
}

/// Names of earlier headers.
const OLD: [&str; 38] = [
    "NEARMISS_CHOICE",
    "NEARMISS_STAMP",
    "NEARMISS_STATIC",
    "NEARMISS_FV",
    "NEARMISS_CONTACT,",
    "NEARMISS_CONTACT ",
    "NEARMISS_UNRESOLVED",
    "NEARMISS_SELF_CONTACT",
    "NEARMISS_AT",
    "NEARMISS_POSES",
    "NearmissSelfContact",
    "NearmissInput",
    "nearmiss_detector_new",
    "nearmiss_detector_frame",
    "nearmiss_detector_place",
    "nearmiss_detector_detect",
    "nearmiss_scene_new",
    "nearmiss_interrupt_new",
    "nearmiss_device_borrow",
    "nearmiss_device_interruptible",
    "nearmiss_device_limit",
    "nearmiss_answer_degraded",
    "nearmiss_at(",
    "nearmiss_step(",
    "nearmiss_pose(",
    "nearmiss_poses(",
    "self_contact",
    "toi_hi",
    " a;",
    " b;",
    " first[",
    "unresolved",
    "degraded",
    " separation;",
    " budget",
    " bv;",
    " broad;",
    "inputs",
];

fn old_name(header: &str) -> Option<&'static str> {
    OLD.into_iter().find(|old| header.contains(old))
}

#[test]
fn no_name_of_an_earlier_header_is_left() {
    let header = made();
    assert_eq!(old_name(&header), None);
    for old in OLD {
        assert_eq!(old_name(&format!("{header}{old}")), Some(old), "planted");
    }
}

/// A name that two values have: in C, names of all enums are of one space.
fn name_of_two_values(list: &str) -> Option<&str> {
    let mut names = std::collections::BTreeSet::new();
    let mut values = list.lines().filter_map(|line| line.strip_prefix("value ")?.split(' ').nth(1));
    values.find(|&name| !names.insert(name))
}

#[test]
fn no_two_values_have_one_name() {
    let list = Layout::of(&made()).list();
    assert!(list.contains("value NearmissQueryKind NEARMISS_NEAR 3\n"));
    assert_eq!(name_of_two_values(&list), None);
    let planted = list.replace("NEARMISS_NEAREST 3", "NEARMISS_NEAR 3");
    assert_eq!(name_of_two_values(&planted), Some("NEARMISS_NEAR"));
}

/// The first line that is wider than 100 columns.
fn wide_line(header: &str) -> Option<&str> {
    header.lines().find(|line| line.starts_with(['/', ' ']) && line.chars().count() > 100)
}

#[test]
fn comments_have_at_most_100_columns() {
    let header = made();
    assert_eq!(wide_line(&header), None);
    let planted = header.replace("// Success.", &format!("// Success{}.", " and more".repeat(12)));
    assert!(wide_line(&planted).is_some_and(|line| line.contains("and more")));
}

/// The sizes that the list was computed with are those of the compiler.
#[cfg(target_pointer_width = "64")]
#[test]
fn the_compiler_lays_out_the_same() {
    macro_rules! shapes {
        ($($of:ty),* $(,)?) => {
            [$((stringify!($of), Shape { size: size_of::<$of>(), align: align_of::<$of>() })),*]
        };
    }
    let compiled = shapes![
        NearmissBackend,
        NearmissBody,
        NearmissBodyKind,
        NearmissClosest,
        NearmissCode,
        NearmissContact,
        NearmissCurves,
        NearmissDeviceAnswer,
        NearmissDeviceExtras,
        NearmissDeviceHit,
        NearmissDeviceList,
        NearmissDeviceNearHit,
        NearmissDeviceNearest,
        NearmissDevicePair,
        NearmissDeviceRowGeometry,
        NearmissEntries,
        NearmissError,
        NearmissExclusions,
        NearmissExtrasOnDevice,
        NearmissFrameStatus,
        NearmissGeometry,
        NearmissGroupBy,
        NearmissGrouped,
        NearmissKind,
        NearmissMotion,
        NearmissMotionKind,
        NearmissBodyPair,
        NearmissNearPair,
        NearmissNearest,
        NearmissNumber,
        NearmissPairGeometry,
        NearmissPairKind,
        NearmissPose,
        NearmissPoseRows,
        NearmissQuery,
        NearmissQueryKind,
        NearmissRebuild,
        NearmissResearch,
        NearmissRows,
        NearmissSelfCollision,
        NearmissShare,
        NearmissStages,
        NearmissStatus,
        NearmissSummary,
        NearmissTrianglePair,
    ];
    let header = Layout::of(&made());
    for (name, shape) in compiled {
        assert_eq!(header.shapes.get(name), Some(&shape), "{name}");
    }
    for name in header.shapes.keys() {
        assert!(compiled.iter().any(|(known, _)| known == name), "{name} is not in this test");
    }
}
