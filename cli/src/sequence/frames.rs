//! The frames of a mesh, file by file.

use crate::meshes::Reader;
use nearmiss::error::Error;
use nearmiss::mesh::Positions;
use nearmiss_io::MeshFile;
use std::path::PathBuf;

/// A mesh and its positions, frame after frame: all in double precision if any is.
pub struct Frames {
    pub mesh: MeshFile,
    /// A frame that cannot be used has the positions of one that can. It is never tested.
    pub positions: Vec<Positions>,
    /// Why a frame cannot be used.
    pub reasons: Vec<Option<String>>,
}

impl Frames {
    /// Reads all files; the faces are those of the first that can be read.
    ///
    /// # Errors
    /// Those of reading. A reader that keeps going passes over bad frames, except if all are.
    pub fn read(files: &[PathBuf], reader: &mut Reader) -> Result<Frames, Error> {
        let mut mesh: Option<MeshFile> = None;
        let mut read = Vec::with_capacity(files.len());
        let (mut reasons, mut first) = (Vec::with_capacity(files.len()), None);
        for file in files {
            let frame = match &mesh {
                None => reader.mesh(file),
                Some(mesh) => reader.frame(mesh, file),
            };
            match frame {
                Ok(frame) => {
                    read.push(Some(frame.mesh().positions().clone()));
                    mesh.get_or_insert(frame);
                    reasons.push(None);
                }
                Err(e @ Error::Input { .. }) if reader.keep_going => {
                    read.push(None);
                    reasons.push(Some(e.to_string()));
                    first.get_or_insert(e);
                }
                Err(e) => return Err(e),
            }
        }
        let Some(mesh) = mesh else {
            return Err(first.unwrap_or(Error::Bug { what: "a mesh without files".into() }));
        };
        let mut last = mesh.mesh().positions().clone();
        let fill = |frame: Option<Positions>| {
            if let Some(frame) = frame {
                last = frame;
            }
            last.clone()
        };
        let mut positions: Vec<Positions> = read.into_iter().map(fill).collect();
        if positions.iter().any(Positions::is_f64) {
            positions = positions.iter().map(|frame| Positions::F64(frame.to_f64())).collect();
        }
        Ok(Frames { mesh, positions, reasons })
    }
}
