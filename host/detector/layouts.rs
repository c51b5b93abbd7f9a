//! Layouts: the place of every body in the shared memory, by query.

use super::engine::fits;
use super::thick::meets_thin;
use crate::device::Device;
use crate::error::Error;
use crate::memory;
use crate::pipeline::Layout;
use crate::query::Query;
use crate::scene::{Body, Scene};
use std::sync::Arc;

/// Fewest bytes of host memory for a triangle: its topology, and on a CPU its tree and first lists.
const OF_A_TRIANGLE: u64 = 300;

/// Properties of a query that its layout depends on.
#[derive(Clone, Copy, PartialEq)]
struct View {
    has_features: bool,
    is_within_bodies: bool,
    keeps_adjacent: bool,
}

impl View {
    fn of(query: &Query) -> View {
        View {
            has_features: query.kind().is_of_features(),
            is_within_bodies: query.kind().is_within_bodies(),
            keeps_adjacent: query.keeps_adjacent(),
        }
    }
}

/// Layouts of a scene, made when a query first needs them; equal parts are shared.
#[derive(Default)]
pub struct Layouts(Vec<(View, Arc<Layout>)>);

impl Layouts {
    /// Returns the layout of a query.
    ///
    /// # Errors
    /// [`Error::Input`] for more triangles than indices reach, [`Error::OutOfMemory`],
    /// [`Error::Interrupted`].
    pub fn of(&mut self, device: &Device, scene: &Scene, query: &Query) -> Result<Arc<Layout>, Error> {
        let view = View::of(query);
        if let Some((_, layout)) = self.0.iter().find(|(own, _)| *own == view) {
            return Ok(layout.clone());
        }
        let (bodies, looks) = (scene.bodies(), device.looks());
        let triangles: usize = bodies.iter().map(Body::element_count).sum();
        fits(triangles, bodies.iter().map(Body::vertex_count).sum())?;
        memory::require("trees and lists", triangles as u64 * OF_A_TRIANGLE)?;
        // One with features is preferred: they take longest to make.
        let known = self.0.iter().find(|(own, _)| own.has_features).or_else(|| self.0.first());
        let made = match known {
            Some((_, known)) => {
                let layout = known.seen_by(bodies, query.kind());
                let is_done = !view.has_features || layout.has_features();
                if is_done { Some(layout) } else { layout.with_features(bodies, &looks) }
            }
            None => match Layout::within(bodies, query.kind(), &looks) {
                Some(layout) => {
                    let layout = layout.without(scene.left_out()).excluding(scene, &looks)?;
                    Some(Layout { meets_thin: meets_thin(scene), ..layout })
                }
                None => None,
            },
        };
        let mut layout = made.ok_or(Error::Interrupted)?;
        layout.find_hubs(query.keeps_adjacent());
        let layout = Arc::new(layout);
        self.0.push((view, layout.clone()));
        Ok(layout)
    }

    /// Returns any layout of the unchanged bodies, if one was made.
    pub fn any(&self) -> Option<&Arc<Layout>> {
        self.0.first().map(|(_, layout)| layout)
    }

    /// Returns a layout of the unchanged bodies by which something may meet, if one was made.
    pub fn meeting(&self) -> Option<&Arc<Layout>> {
        self.0.iter().map(|(_, layout)| layout).find(|layout| layout.may_meet())
    }
}
