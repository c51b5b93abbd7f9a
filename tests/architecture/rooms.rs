//! The ground floor of the host: what is given, asked and answered are values that know no device.

use super::sources::{NONE, Source, after, lines, planted, rust};

const GROUND_FLOOR: [&str; 4] = ["host/mesh", "host/scene", "host/query", "host/contacts"];

/// Rooms above it.
const ABOVE: [&str; 4] = ["pipeline", "device", "detector", "several"];

fn climbs(sources: &[Source]) -> Vec<String> {
    lines(sources, |_, code| after(code, "crate::").any(|next| ABOVE.contains(&next)))
}

#[test]
fn values_know_no_device() {
    assert_eq!(climbs(&rust(&GROUND_FLOOR)), NONE);
}

#[test]
fn a_value_that_knows_the_device_is_noticed() {
    for line in ["use crate::pipeline::Layout;", "let device: crate::device::Device;"] {
        assert_eq!(climbs(&planted("host/contacts/near.rs", line)).len(), 1, "{line}");
    }
    let line = "use crate::mesh::Mesh; // see crate::device";
    assert_eq!(climbs(&planted("host/scene/body.rs", line)), NONE);
}
