//! Which machine figures are of.

use nearmiss::device::Device;
use serde::Serialize;
use std::fmt;

/// A machine, as files of figures name it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// A GPU's name, or a processor's.
    pub machine: String,
    /// Threads of a CPU; a GPU has none.
    pub threads: Option<usize>,
}

impl Machine {
    /// That of a device, by so many threads if it is a CPU.
    pub fn of(device: &Device, threads: usize) -> Machine {
        if device.is_gpu() {
            return Machine { machine: device.name(), threads: None };
        }
        let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let machine = processor(&told).unwrap_or(std::env::consts::ARCH).to_owned();
        Machine { machine, threads: Some(threads) }
    }
}

/// The first processor's name in Linux's list; none where it has none.
fn processor(told: &str) -> Option<&str> {
    let name = |line: &'_ str| line.split_once(':').filter(|(key, _)| key.trim() == "model name").is_some();
    let line = told.lines().find(|line| name(line))?;
    line.split_once(':').map(|(_, name)| name.trim()).filter(|name| !name.is_empty())
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.machine)?;
        match self.threads {
            None => Ok(()),
            Some(1) => write!(f, ", 1 thread"),
            Some(threads) => write!(f, ", {threads} threads"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_named_as_the_system_does() {
        let told = "processor\t: 0\nmodel\t\t: 17\nmodel name\t: A Fast One\n\nmodel name\t: Another\n";
        assert_eq!(processor(told), Some("A Fast One"));
        for nameless in ["", "model name\t:\n", "processor\t: 0\nBogoMIPS\t: 50.00\n"] {
            assert_eq!(processor(nameless), None, "{nameless}");
        }
    }
}
