//! The one clean-up at the root: films and slits thinner than rounding can tell are removed.
//!
//! First every gap, judged on its own exact ends, is filled, then every span dropped, whose width along the normal,
//! dt |dir| max(|d.n_a|, |d.n_b|), is at most tau = 16 eps S + e_a + e_b. The first surface is reported as soon as no
//! later crossing can change it.

use super::object::Core;
use super::owner::boundary;
use super::spans::{Boundary, Span};
use super::sweep::{Change, Sweep};
use crate::geom::{Ray, tolerance};
use glam::DVec3;

/// Changes of an object with the clean-up applied, lazily.
pub(super) struct Cleaner<'a> {
    pub sweep: Sweep<'a>,
    /// A change already taken from the sweep.
    ahead: Option<Change>,
    /// How far the ray begins from the world's own origin.
    origin: f64,
    /// The largest tau that two leaves of the tree can have on this ray near its range.
    reach: f64,
    /// Whether the next span has already begun where the range begins.
    open: bool,
}

/// The largest that any leaf of a tree brings in, world lengths.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Bound {
    /// Of the scale of rounding errors ([`super::Leaf::scale`]).
    pub scale: f64,
    /// Of the error of a crossing.
    pub shift: f64,
    /// Of what a leaf does not resolve.
    pub grain: f64,
}

/// The largest tau that two leaves of a tree can have on a ray near where it begins.
pub(super) fn reach(core: &Core, ray: &Ray) -> f64 {
    let Bound { shift, scale, .. } = core.bound;
    // Two crossings, one for either face.
    2.0 * shift + tolerance::cleanup(scale.max(ray.origin.length()))
}

/// A change with its face.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub change: Change,
    /// The outward unit normal of the leaf that crosses, the object's frame.
    pub normal: DVec3,
    /// |dir . n|.
    pub slope: f64,
}

impl<'a> Cleaner<'a> {
    /// Starts the sweep.
    pub fn new(mut sweep: Sweep<'a>) -> Cleaner<'a> {
        let open = sweep.begin();
        let (origin, reach) = (sweep.ray.origin.length(), reach(sweep.core, sweep.ray));
        Cleaner { sweep, ahead: None, origin, reach, open }
    }

    fn face(&mut self, change: Change) -> Face {
        let normal = self.sweep.leaf_normal(change.met, &change.crossing);
        Face { change, normal, slope: self.sweep.ray.dir.dot(normal).abs() }
    }

    /// Whether what lies between two faces is too thin to be told from nothing.
    fn is_thin(&self, a: &Face, b: &Face) -> bool {
        (b.change.t - a.change.t) * a.slope.max(b.slope) <= self.tau(&a.change, &b.change)
    }

    fn tau(&self, a: &Change, b: &Change) -> f64 {
        let ray = self.sweep.ray;
        let core = self.sweep.core;
        let leaves = [a, b].map(|c| self.sweep.room.met[c.met as usize].leaf as usize);
        // Of the two points the nearer: a ray and its reverse find the same thin, and none past the horizon.
        let scale = self.origin.max(ray.at(a.t).length().min(ray.at(b.t).length()));
        let own = |i: usize, c: &Change| core.scale_at(leaves[i], &c.crossing);
        let scale = scale.max(own(0, a)).max(own(1, b));
        let error = |i: usize, c: &Change| c.crossing.shift * core.tree.leaves()[leaves[i]].place.stretch;
        tolerance::cleanup(scale) + error(0, a) + error(1, b)
    }

    /// Past this t nothing can be thin together with a face.
    fn horizon(&self, face: &Face) -> f64 {
        let grown = self.reach + tolerance::cleanup(self.sweep.ray.at(face.change.t).length());
        face.change.t + grown / face.slope
    }

    /// The next change not after `limit`.
    fn take(&mut self, limit: f64) -> Option<Face> {
        let change = match self.ahead.take() {
            Some(ahead) if ahead.t <= limit => ahead,
            Some(ahead) => {
                self.ahead = Some(ahead);
                return None;
            }
            None => self.sweep.next_until(limit)?,
        };
        Some(self.face(change))
    }

    /// The exit of a span that has begun, gaps too thin to be told filled; `None` where there is none up to the limit
    /// given for a first exit. An exit found is final.
    fn exit(&mut self, limit: f64) -> Option<Face> {
        let mut exit = self.take(limit)?;
        loop {
            let horizon = self.horizon(&exit);
            let Some(entry) = self.take(horizon) else { return Some(exit) };
            if !self.is_thin(&exit, &entry) {
                self.ahead = Some(entry.change);
                return Some(exit);
            }
            self.sweep.scratch.counts.cleaned += 1;
            exit = self.take(f64::INFINITY)?;
        }
    }

    /// The next span that survives.
    pub fn span(&mut self) -> Option<Span> {
        loop {
            let enter = if std::mem::take(&mut self.open) { None } else { Some(self.take(f64::INFINITY)?) };
            let exit = self.exit(f64::INFINITY);
            if let (Some(a), Some(b)) = (&enter, &exit)
                && self.is_thin(a, b)
            {
                self.sweep.scratch.counts.cleaned += 1;
                continue;
            }
            let [enter, exit] = [enter, exit].map(|f| f.map(|f| self.owned(&f)));
            return Some(Span { enter, exit });
        }
    }

    /// The first boundary of the first span that survives, and whether the ray goes in there.
    pub fn first(&mut self) -> Option<(Boundary, bool)> {
        self.first_face().map(|(face, entering)| (self.owned(&face), entering))
    }

    /// Whether any span survives. A ray that asks this leaves a surface; spans that end so near to where it begins
    /// that the leaf they end on does not resolve them ([`crate::solid::Solid::grain`]) hide nothing.
    pub fn any(&mut self) -> bool {
        let begin = self.sweep.range.lo;
        loop {
            let open = std::mem::take(&mut self.open);
            let enter = if open { None } else { self.take(f64::INFINITY) };
            if !open && enter.is_none() {
                return false;
            }
            let length = self.sweep.ray.dir.length();
            let coarsest = self.sweep.core.bound.grain;
            let limit = match &enter {
                None => f64::INFINITY,
                Some(face) => self.horizon(face).max(begin + coarsest / length),
            };
            let Some(exit) = self.exit(limit) else { return true };
            let leaf = self.sweep.room.met[exit.change.met as usize].leaf;
            let grain = self.sweep.core.tree.leaves()[leaf as usize].grain_at(&exit.change.crossing);
            let unresolved = (exit.change.t - begin) * length <= grain;
            let thin = enter.is_some_and(|enter| self.is_thin(&enter, &exit));
            if !unresolved && !thin {
                return true;
            }
            self.sweep.scratch.counts.cleaned += 1;
        }
    }

    fn first_face(&mut self) -> Option<(Face, bool)> {
        if std::mem::take(&mut self.open) {
            return self.exit(f64::INFINITY).map(|exit| (exit, false));
        }
        loop {
            let enter = self.take(f64::INFINITY)?;
            let horizon = self.horizon(&enter);
            match self.exit(horizon) {
                Some(exit) if self.is_thin(&enter, &exit) => self.sweep.scratch.counts.cleaned += 1,
                _ => return Some((enter, true)),
            }
        }
    }

    fn owned(&mut self, face: &Face) -> Boundary {
        let reach = self.reach;
        boundary(&mut self.sweep, face, reach)
    }
}
