//! What several test binaries share.
#![allow(dead_code, reason = "each binary uses a part")]

use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::mesh::{Body, Mesh};
use nearmiss::{Device, Query, Session};
use std::io::Read;
use std::path::PathBuf;

/// The folder of public test data: `NEARMISS_DATA`, else beside the repository.
pub fn data(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("NEARMISS_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")), PathBuf::from);
    let path = root.join(path);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: no {} (set NEARMISS_DATA to the folder of public test data)", path.display());
    None
}

/// A mesh of the public test data.
pub fn mesh(path: &str) -> Option<Mesh> {
    data(path).map(|path| Mesh::read(&path).expect("public data is a mesh"))
}

/// Rows of a gzip CSV of the public test data, without the header.
pub fn rows(path: &str) -> Option<Vec<Vec<String>>> {
    let file = std::fs::File::open(data(path)?).expect("readable");
    let mut text = String::new();
    flate2::read::GzDecoder::new(file).read_to_string(&mut text).expect("gzip text");
    Some(text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

/// The engine, on all cores.
pub fn engine() -> Device {
    Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"))
}

/// A microscope in that order.
pub fn microscope(order: Order) -> Device {
    Device::emulator(Emulator::new(Mode::Microscope(order), None).expect("threads"))
}

/// Every order that the tests run.
pub const ORDERS: [Order; 3] = [Order::Forward, Order::Reverse, Order::Shuffled(20_261_121)];

/// One answer on one device.
pub fn ask(device: Device, bodies: Vec<Body>, query: Query) -> nearmiss::Contacts {
    let mut session = Session::new(device, bodies, query).expect("a session");
    let contacts = session.detect().expect("an answer");
    session.check_trees().expect("sound trees");
    contacts
}
