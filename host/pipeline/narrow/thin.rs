//! Pairs of features without a thickness, in a scene in which others have one: they touch, the others
//! have a separation.
//!
//! Triangle pairs are divided by the radii of their vertices. Thin ones take all steps of a query of a
//! scene without radii, in lists of their own. Both solvers append to the same contacts, and lower the
//! same earliest time. A body with vertices of both sorts has triangle pairs that are thin and thick:
//! there pairs of features are sifted by their own vertices.

use super::cull;
use super::exclude::Kept;
use super::left::{OfKinds, THIN, lists, named_lists};
use super::rungs::Rungs;
use super::{Capacities, NarrowContext, growable};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::list::{GrowableOutput, List, Named};
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::query::{Certified, ContinuousSolver};
use nearmiss_kernels::abi::{
    BodyTolerance, DivideThickArgs, Hit, Output, Pair, SiftThickArgs, Span, counter,
};
use nearmiss_kernels::entry::{narrow_divide_thick, narrow_sift_thick};

/// Returns the solver of pairs with a thickness, or of all in a scene without. A thickness is a
/// separation: a query without one gets the smallest, which no sum with a radius has.
pub fn solver_in(solver: ContinuousSolver, is_thick: bool) -> ContinuousSolver {
    let touching = solver.certified().filter(|certified| is_thick && !certified.is_apart());
    let apart = |of: &Certified| Certified { min_separation: f64::MIN_POSITIVE, ..*of }.into();
    touching.map_or(solver, apart)
}

/// Returns whether pairs of a scene take two solvers.
pub fn is_mixed(solver: ContinuousSolver, layout: &Layout) -> bool {
    layout.meets_thin && solver.certified().is_some_and(|certified| !certified.is_apart())
}

/// Triangle pairs: thin ones, then thick ones.
const DIVIDED: OfKinds = [
    ("narrow: thin triangle pairs", "triangle pairs without a thickness", counter::THIN_PAIRS),
    ("narrow: thick triangle pairs", "triangle pairs with a thickness", counter::THICK_PAIRS),
];
/// Candidates of the thin ones.
const CANDIDATES: OfKinds = [
    ("narrow: thin vf", "thin vertex/face candidates", counter::VF_THIN),
    ("narrow: thin ee", "thin edge/edge candidates", counter::EE_THIN),
];
/// Pairs of features without a thickness, of both sorts of triangles.
const ALL_THIN: OfKinds = [
    ("narrow: vf of thin vertices", "vertex/face pairs without a thickness", counter::VF_ALL_THIN),
    ("narrow: ee of thin vertices", "edge/edge pairs without a thickness", counter::EE_ALL_THIN),
];
/// Pairs of features with one.
const SOME_THICK: OfKinds = [
    ("narrow: vf with thick vertices", "vertex/face pairs with a thickness", counter::VF_SOME_THICK),
    ("narrow: ee with thick vertices", "edge/edge pairs with a thickness", counter::EE_SOME_THICK),
];
/// Thin pairs that the cull keeps.
const SURVIVORS: OfKinds = [
    ("narrow: thin vf that may meet", "thin vertex/face pairs that may meet", counter::VF_SURVIVORS),
    ("narrow: thin ee that may meet", "thin edge/edge pairs that may meet", counter::EE_SURVIVORS),
];

/// The lists of those pairs, and their solver.
pub struct Thin {
    certified: Certified,
    /// The thickness of every vertex.
    radii: Buffer<f64>,
    /// Triangle pairs: those that may hold thin pairs of features, and those that may hold others.
    pairs: [List<Pair>; 2],
    /// Thin pairs of features; if some are sifted, with others of the same triangles.
    candidates: [List<Pair>; 2],
    sifted: Option<Sifted>,
    /// Those that may meet.
    survivors: [List<Pair>; 2],
    /// Those of them that are not excluded, in a scene that excludes some.
    kept: Option<Kept>,
    rungs: Rungs,
}

/// Pairs of features, by their own vertices: in a scene with a body of which only some vertices have a
/// thickness.
struct Sifted {
    thin: [List<Pair>; 2],
    thick: [List<Pair>; 2],
}

impl Thin {
    /// Allocates the lists.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        certified: &Certified,
        layout: &Layout,
        capacities: &Capacities,
    ) -> Result<Self, Error> {
        let few = capacities.survivors;
        let sifted = || {
            Ok::<_, Error>(Sifted {
                thin: lists(device, ALL_THIN, few)?,
                thick: lists(device, SOME_THICK, few)?,
            })
        };
        Ok(Thin {
            certified: *certified,
            radii: device.of(purpose::RADII).upload(&layout.radii)?,
            pairs: lists(device, DIVIDED, [few[1]; 2])?,
            candidates: lists(device, CANDIDATES, few)?,
            sifted: layout.is_ragged.then(sifted).transpose()?,
            survivors: lists(device, SURVIVORS, few)?,
            kept: None,
            rungs: Rungs::new(device, (Some(certified), &THIN), capacities)?,
        })
    }

    /// Drops pairs that are excluded.
    ///
    /// # Errors
    /// Device errors.
    pub fn exclude(&mut self, device: &Device, capacities: &Capacities) -> Result<(), Error> {
        let names = [
            ("thin vertex/face pairs that are not excluded", counter::VF_THIN_KEPT),
            ("thin edge/edge pairs that are not excluded", counter::EE_THIN_KEPT),
        ];
        self.kept = Some(Kept::new(device, names, capacities.survivors)?);
        Ok(())
    }

    /// Sets the numbers of another solver of the same precision, and the tolerances of bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn set(
        &mut self,
        device: &Device,
        certified: &Certified,
        tolerances: &[BodyTolerance],
    ) -> Result<(), Error> {
        self.certified = *certified;
        let own = |record: &BodyTolerance| BodyTolerance { radius: 0.0, ..*record };
        let is_same = |pair: &[BodyTolerance]| pair[0].tolerance == pair[1].tolerance;
        // As in a scene without radii: none if all pairs have the same.
        let differ = !tolerances.windows(2).all(is_same);
        let records: Vec<_> = if differ { tolerances.iter().map(own).collect() } else { Vec::new() };
        self.rungs.set(device, certified, &records)
    }

    /// Returns its choices: those of the query.
    pub fn certified(&self) -> &Certified {
        &self.certified
    }

    /// Divides triangle pairs. Returns those that may hold pairs of features with a thickness.
    ///
    /// # Errors
    /// Device errors.
    pub fn divide<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        pairs: Output<Pair>,
    ) -> Result<Output<Pair>, Error> {
        let [thin, thick] = self.pairs.each_ref().map(|list| list.output(given.counters));
        let args = DivideThickArgs { radii: self.radii.span(), faces: given.faces, pairs, thin, thick };
        launch::striding::<narrow_divide_thick>(given.device, pairs.room() as usize, &args)?;
        Ok(thick)
    }

    /// Lists the thin pairs of features. `given.features` has the candidates of the others.
    ///
    /// # Errors
    /// Device errors.
    pub fn features<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let [pairs, _] = self.pairs.each_ref().map(|list| list.output(given.counters));
        let into = self.candidates.each_ref();
        given.features.run_into::<R, R::Features>(given, pairs, (0.0, Span::EMPTY), into)?;
        let Some(sifted) = &self.sifted else { return Ok(()) };
        let outputs = |of: &[List<Pair>; 2]| of.each_ref().map(|list| list.output(given.counters));
        let ([thin_vf, thin_ee], [thick_vf, thick_ee]) =
            (outputs(&self.candidates), outputs(&given.features.candidates));
        let ([all_thin_vf, all_thin_ee], [some_thick_vf, some_thick_ee]) =
            (outputs(&sifted.thin), outputs(&sifted.thick));
        let args = SiftThickArgs {
            radii: self.radii.span(),
            faces: given.faces,
            edges: given.features.edges.span(),
            thin_vf,
            thin_ee,
            thick_vf,
            thick_ee,
            all_thin_vf,
            all_thin_ee,
            some_thick_vf,
            some_thick_ee,
        };
        let all = self.candidates.iter().chain(&given.features.candidates).map(List::capacity).max();
        launch::striding::<narrow_sift_thick>(given.device, all.unwrap_or(0), &args)
    }

    /// Returns the pairs of features with a thickness, if they are sifted.
    pub fn thick(&self) -> Option<[&List<Pair>; 2]> {
        self.sifted.as_ref().map(|sifted| sifted.thick.each_ref())
    }

    /// Launches the cull, which keeps thin pairs that may meet.
    ///
    /// # Errors
    /// Device errors.
    pub fn cull<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        let thin = self.sifted.as_ref().map_or(&self.candidates, |sifted| &sifted.thin);
        cull::run(given, [thin, &self.survivors], Some(&self.certified), Span::EMPTY)
    }

    /// Launches the step that drops thin pairs that are excluded.
    ///
    /// # Errors
    /// Device errors.
    pub fn keep<R: Precision>(&self, given: &NarrowContext<R>) -> Result<(), Error> {
        self.kept.as_ref().map_or(Ok(()), |kept| kept.run(given, self.survivors.each_ref()))
    }

    /// Returns the pairs that the solver tests.
    pub fn tested(&self) -> [&List<Pair>; 2] {
        self.kept.as_ref().map_or(self.survivors.each_ref(), Kept::lists)
    }

    /// Launches the solver.
    ///
    /// # Errors
    /// Device errors.
    pub fn solve<R: Precision>(
        &self,
        given: &NarrowContext<R>,
        (tested, hits, earliest): ([&List<Pair>; 2], [&List<Hit>; 2], Span<u64>),
    ) -> Result<(), Error> {
        let edges = given.features.edges.span();
        self.rungs.climb(given, (edges, given.is_sample), (tested, hits, earliest))
    }

    /// Returns the lists that [`Thin::divide`] and [`Thin::features`] fill.
    pub fn listed(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        let sifted =
            self.sifted.iter_mut().flat_map(|sifted| sifted.thin.iter_mut().chain(&mut sifted.thick));
        growable(self.pairs.iter_mut().chain(&mut self.candidates).chain(sifted))
    }

    /// Returns the lists that [`Thin::cull`] fills.
    pub fn culled(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        growable(&mut self.survivors)
    }

    /// Returns the lists that [`Thin::keep`] fills.
    pub fn kept(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        self.kept.iter_mut().flat_map(Kept::growable)
    }

    /// Returns the lists that [`Thin::solve`] fills.
    pub fn left(&mut self) -> impl Iterator<Item = &mut dyn GrowableOutput> {
        self.rungs.lists()
    }

    /// Returns the lists, with names: for comparing machines.
    pub fn between(&self) -> Vec<Named<'_>> {
        let mut all: Vec<_> = named_lists(&self.pairs, DIVIDED).collect();
        all.extend(named_lists(&self.candidates, CANDIDATES));
        all.extend(named_lists(&self.survivors, SURVIVORS));
        if let Some(Sifted { thin, thick }) = &self.sifted {
            all.extend(named_lists(thin, ALL_THIN).chain(named_lists(thick, SOME_THICK)));
        }
        let names = ["narrow: thin vf that are not excluded", "narrow: thin ee that are not excluded"];
        all.extend(self.kept.iter().flat_map(|kept| kept.between(names)));
        all.extend(self.rungs.between());
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::CertifiedPrecision;

    #[test]
    fn a_thickness_is_a_separation_and_other_queries_keep_their_solver() {
        for precision in CertifiedPrecision::ALL {
            let touching = Certified { tolerance: Some(0.5), ..Certified::by(precision) };
            let apart = Certified { min_separation: 0.25, ..touching };
            let thick = solver_in(touching.into(), true);
            assert_eq!(thick, Certified { min_separation: f64::MIN_POSITIVE, ..touching }.into());
            for (solver, is_thick) in [(touching, false), (apart, false), (apart, true)] {
                assert_eq!(solver_in(solver.into(), is_thick), solver.into());
            }
            let layout = |meets_thin| Layout { meets_thin, ..Layout::default() };
            assert!(is_mixed(touching.into(), &layout(true)) && !is_mixed(apart.into(), &layout(true)));
            assert!(!is_mixed(touching.into(), &layout(false)));
        }
    }
}
