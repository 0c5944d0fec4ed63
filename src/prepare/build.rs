//! Solids from calls, and scans from clouds, each built once however often its shape is used.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::equal::Likeness;
use super::fitness::{self, Concern, Fitness};
use super::flat::flat;
use super::{ScanReport, complaint, files};
use crate::cloud::Known;
use crate::cloud::holes::{Hole, holes_by};
use crate::cloud::scraps::bounding;
use crate::cloud::winding::Winding;
use crate::cloud::{Cloud, CloudError, CloudFault, NormalSource, SampleOptions, Samples, is_single, ply};
use crate::diag::{Diagnostic, Fault};
use crate::num::median::median;
use crate::scene::{Call, MaterialId, ShapeNode, Value};
use crate::shot::Material;
use crate::solid::point_set::{Lead, Options, PointSet, Solidity};
use crate::solid::table::Made;
use crate::solid::{Body, Counts, Solid, points};
use crate::source::Span;

/// A scan, with what has been found out about it so far.
#[derive(Debug)]
struct Scan {
    whole: Part,
    /// What is known of the samples' neighbours, until their holes are.
    known: Option<Known>,
    sampling: SampleOptions,
    options: Options,
    measured: Option<(Solidity, Arc<PointSet>)>,
    /// What bounds an inside, with its holes, once it was asked for; the same as the whole where nothing was left out.
    bounding: Option<(Part, Vec<Hole>)>,
    /// Closed with holes up to so wide, own units.
    closed: Vec<(f64, Arc<PointSet>)>,
}

/// Samples and their surface.
#[derive(Clone, Debug)]
struct Part {
    samples: Arc<Samples>,
    surface: Arc<PointSet>,
}

/// What a leaf has become.
#[derive(Clone, Debug)]
pub(super) enum Built {
    /// A closed form.
    Exact(Arc<dyn Solid>),
    /// A scan.
    Scan(ScanId),
}

/// A scan of a [`Builder`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct ScanId(usize);

/// Builds calls and keeps what it has built.
#[derive(Debug)]
pub(super) struct Builder<'a> {
    options: &'a super::Options,
    /// The scene's materials.
    pub materials: &'a [Material],
    /// How many rays the whole picture sends from the eye.
    lines: u64,
    /// By the address of the node, which lives as long as the scene.
    built: HashMap<usize, Built>,
    /// Solids of closed form by the calls that made them.
    equal: HashMap<Likeness, Arc<dyn Solid>>,
    scan: Vec<Scan>,
    /// Scans made of scans by moving their boundary, and what they were made by.
    pub moved: Vec<(super::offset::Key, ScanId)>,
    /// Scans given a thickness, own units.
    pub thick: Vec<((ScanId, f64), Arc<dyn Solid>)>,
    /// What the user should know.
    pub warnings: Vec<Diagnostic>,
    /// Time spent on reading them.
    pub loading: Duration,
    /// The work of measuring.
    pub counts: Counts,
    /// What was found about each scan.
    pub scans: Vec<ScanReport>,
}

/// Patches are fitted to scans of which each sample has so many rays of the eye, over the whole picture. A patch costs some 25
/// projections for up to 32 samples, and saves one or two each time that a ray meets it; about half of the rays meet a
/// scan that fills the picture, half of whose samples are in sight.
const PATCHES: f64 = 2.0;

impl<'a> Builder<'a> {
    /// Nothing built yet.
    pub fn new(options: &'a super::Options, materials: &'a [Material], lines: u64) -> Builder<'a> {
        Builder {
            options,
            materials,
            lines,
            built: HashMap::new(),
            equal: HashMap::new(),
            scan: Vec::new(),
            moved: Vec::new(),
            thick: Vec::new(),
            warnings: Vec::new(),
            loading: Duration::ZERO,
            counts: Counts::default(),
            scans: Vec::new(),
        }
    }

    /// What a node has been built to.
    pub fn known(&self, node: &ShapeNode) -> Option<Built> {
        self.built.get(&(std::ptr::from_ref(node) as usize)).cloned()
    }

    /// Remembers it.
    pub fn keep(&mut self, node: &ShapeNode, built: Built) -> Built {
        self.built.insert(std::ptr::from_ref(node) as usize, built.clone());
        built
    }

    /// What a call makes of its arguments alone; calls that say the same make one solid.
    pub fn exact(&mut self, call: &Call, build: impl Fn(&Call) -> Made) -> Result<Built, Diagnostic> {
        let likeness = Likeness::of(call);
        if let Some(known) = likeness.as_ref().and_then(|l| self.equal.get(l)) {
            return Ok(Built::Exact(known.clone()));
        }
        let built = exact(call, build)?;
        if let Built::Exact(solid) = &built {
            self.warnings.extend(flat(call, solid.bounds()));
            if let Some(likeness) = likeness {
                self.equal.insert(likeness, solid.clone());
            }
        }
        Ok(built)
    }

    /// The cloud that a call of `points` names.
    pub fn read_cloud(&mut self, call: &Call) -> Result<Cloud, Diagnostic> {
        let Some(Value::Path { text, base, from_command_line }) = call.get("source") else {
            let error = Diagnostic::error("E0404", "`points` needs a file or a solid").at(call.at, "");
            return Err(error.help("write `points(\"scan.ply\")` or `points(sphere(r: 1), samples: 2000)`"));
        };
        let path = self.input(text, base, *from_command_line, call.place("source"))?;
        let begin = Instant::now();
        let cloud = ply::read_path_as(&path, self.options.cut)
            .map_err(|e| cloud_complaint(call, &format!("`{text}`"), e))?;
        self.loading += begin.elapsed();
        self.noted(text, &cloud.notes, call.place("source"));
        Ok(cloud)
    }

    /// The path to open for a name in a scene.
    pub(super) fn input(
        &mut self,
        text: &str,
        base: &Path,
        given: bool,
        at: Span,
    ) -> Result<PathBuf, Diagnostic> {
        let super::Options { scene_dir, allow_read, inputs, .. } = self.options;
        let path = files::resolve(text, base, given, scene_dir, allow_read, at)?;
        inputs.note(&path);
        Ok(path)
    }

    /// Warns of what was dropped or mended in a file.
    pub(super) fn noted(&mut self, text: &str, notes: &[String], at: Span) {
        let warning = |note| Diagnostic::warning("W0102", format!("`{text}`: {note}")).at(at, "");
        self.warnings.extend(notes.iter().map(warning));
    }

    /// Whether any material reads the colours of scans; else none is kept.
    pub fn reads_colors(&self) -> bool {
        self.materials.iter().any(Material::reads_color)
    }

    /// Whether a scan has no colours for a material that reads them.
    pub fn lacks_color(&self, id: ScanId, material: Option<MaterialId>) -> bool {
        let reads =
            material.and_then(|m| self.materials.get(m.0 as usize)).is_some_and(Material::reads_color);
        reads && self.scan[id.0].whole.samples.colors.is_none()
    }

    /// Makes a surface of a cloud.
    pub fn scan(&mut self, call: &Call, name: &str, mut cloud: Cloud) -> Result<ScanId, Diagnostic> {
        if !self.reads_colors() {
            cloud.colors = None;
        }
        let options = SampleOptions {
            smoothing: call.number("smoothing").unwrap_or(1.0),
            width: call.number("h"),
            normals: match call.text("normals") {
                Some("estimate") => NormalSource::Estimate,
                _ => NormalSource::File,
            },
            keep_strays: false,
        };
        let single = is_single(&cloud.points);
        let made = Samples::with_known(cloud, &options);
        let (samples, known) = made.map_err(|e| cloud_complaint(call, "the cloud", e))?;
        let made = points::options(call);
        if let Some(name) = ["h", "smoothing"].into_iter().find(|name| call.get(name).is_some())
            && let Some(message) = fitness::too_wide(&samples)
        {
            let spacing = median(samples.spacing.clone());
            let help = format!("samples are {spacing:.4} apart, and twice that is a usual width");
            return Err(Diagnostic::error("E0605", message).at(call.place(name), "").help(help));
        }
        let concerns = Fitness::new(&samples, &known.tree, single, made.mixed).concerns();
        let warning = |c: Concern| Diagnostic::warning(c.code, c.message).at(call.at, "").help(c.help);
        self.warnings.extend(concerns.into_iter().map(warning));
        let id = self.add(name, samples, options, made);
        self.scan[id.0].known = Some(known);
        Ok(id)
    }

    /// Adds a scan.
    pub fn add(&mut self, name: &str, samples: Samples, sampling: SampleOptions, made: Options) -> ScanId {
        let many = PATCHES * samples.len() as f64 <= self.lines as f64;
        let options = Options { lead: if many { Lead::Patches } else { made.lead }, ..made };
        let notes = samples.notes.clone();
        let estimated = if samples.estimated { samples.len() } else { 0 };
        let name = name.to_owned();
        self.scans.push(ScanReport { name, samples: samples.len(), estimated, notes, solidity: None });
        let whole = Part::new(samples, &options);
        self.scan.push(Scan {
            whole,
            known: None,
            sampling,
            options,
            measured: None,
            bounding: None,
            closed: Vec::new(),
        });
        ScanId(self.scan.len() - 1)
    }

    /// What a scan is made from: its samples, those of its closed surface if asked for, and how they and the surface
    /// were made.
    pub fn parts(&self, id: ScanId, closed: bool) -> (Arc<Samples>, SampleOptions, Options) {
        let scan = &self.scan[id.0];
        let bounding = scan.bounding.as_ref().filter(|_| closed);
        let part = bounding.map_or(&scan.whole, |b| &b.0);
        (part.samples.clone(), scan.sampling, scan.options)
    }

    /// Adds to what is told about a scan.
    pub fn note(&mut self, id: ScanId, note: String) {
        self.scans[id.0].notes.push(note);
    }

    /// Whether a scan was closed before.
    pub fn was_closed(&self, id: ScanId) -> bool {
        self.scan[id.0].bounding.is_some()
    }

    /// The holes of a scan that was closed.
    pub fn closed_holes(&self, id: ScanId) -> &[Hole] {
        self.scan[id.0].bounding.as_ref().map_or(&[], |b| &b.1)
    }

    /// The surface as it stands: a sheet, its solidity not asked for.
    pub fn unmeasured(&self, id: ScanId) -> Arc<PointSet> {
        self.scan[id.0].whole.surface.clone()
    }

    /// What was found about each scan so far.
    pub fn reports(&self) -> Vec<ScanReport> {
        let solidity = |scan: &Scan| scan.measured.as_ref().map(|(solidity, _)| *solidity);
        let all = self.scans.iter().zip(&self.scan);
        all.map(|(report, scan)| ScanReport { solidity: solidity(scan), ..report.clone() }).collect()
    }

    /// The surface with its solidity measured.
    pub fn measured(&mut self, id: ScanId) -> (Solidity, Arc<PointSet>) {
        let scan = &mut self.scan[id.0];
        if scan.measured.is_none() {
            let mut solidity = scan.whole.surface.measure();
            if solidity.body() == Body::Solid {
                let found = scan.whole.holes(scan.known.take());
                try_holes(&mut solidity, &scan.whole.surface, &scan.whole.samples, &found);
            }
            let surface = &scan.whole.surface;
            self.counts.add(&solidity.counts);
            let surface = surface.with_body(solidity.body());
            scan.measured = Some((solidity, Arc::new(surface)));
        }
        let (solidity, surface) = scan.measured.as_ref().unwrap_or_else(|| unreachable!("just measured"));
        (*solidity, surface.clone())
    }

    /// The surface with its holes up to `max_hole` wide capped, or the width of the widest one. Own units. Scraps that
    /// bound nothing are dropped and counted.
    pub fn closed(&mut self, id: ScanId, max_hole: f64) -> Result<Arc<PointSet>, f64> {
        let scan = &mut self.scan[id.0];
        if let Some((_, surface)) = scan.closed.iter().find(|c| c.0 == max_hole) {
            return Ok(surface.clone());
        }
        if scan.bounding.is_none() {
            let (part, scraps) = scan.whole.bounding(&scan.options);
            if 0 < scraps {
                let note = format!("{scraps} samples bound no inside and were dropped to close the scan");
                self.scans[id.0].notes.push(note);
            }
            let known = scan.known.take().filter(|_| scraps == 0);
            let found = part.holes(known);
            scan.bounding = Some((part, found));
        }
        let Some((part, found)) = &scan.bounding else { unreachable!("just made") };
        let widest = found.iter().map(|h| h.width).fold(0.0, f64::max);
        if max_hole < widest {
            return Err(widest);
        }
        let rims: Vec<Vec<u32>> = found.iter().map(|h| h.rim.clone()).collect();
        let surface = Arc::new(part.surface.closed(&rims));
        scan.closed.push((max_hole, surface.clone()));
        Ok(surface)
    }
}

impl Part {
    fn new(samples: Samples, options: &Options) -> Part {
        let surface = surface_of(&samples, options);
        Part { samples: Arc::new(samples), surface }
    }

    /// Their holes; what is known of the samples' neighbours serves.
    fn holes(&self, known: Option<Known>) -> Vec<Hole> {
        holes_by(&self.samples, &known.unwrap_or_else(|| Known::of(&self.samples.points)))
    }

    /// The same without samples that bound no inside, and how many these are.
    fn bounding(&self, options: &Options) -> (Part, usize) {
        let keep = bounding(&self.samples, &self.samples.winding(Winding::OPENING));
        match keep.iter().filter(|k| !**k).count() {
            0 => (self.clone(), 0),
            scraps => (Part::new(self.samples.selected(&keep), options), scraps),
        }
    }
}

/// Adds to what chords say of a surface which of its holes are open.
pub(super) fn try_holes(solidity: &mut Solidity, surface: &PointSet, samples: &Samples, holes: &[Hole]) {
    let length = samples.bounds().diagonal();
    let lines: Vec<_> = holes.iter().map(|hole| hole.lines(&samples.points, length)).collect();
    let open = surface.open_holes(&lines);
    let open = || holes.iter().zip(&open).filter(|h| *h.1).map(|h| h.0);
    let area: f64 = samples.spacing.iter().map(|s| s * s).sum();
    solidity.open_holes = open().count() as u32;
    solidity.missing = open().map(|h| 0.25 * std::f64::consts::PI * h.width * h.width).sum::<f64>() / area;
}

fn surface_of(samples: &Samples, options: &Options) -> Arc<PointSet> {
    let surface = PointSet::new(&samples.points, &samples.normals, &samples.widths, options);
    Arc::new(match &samples.colors {
        Some(colors) => surface.with_colors(colors),
        None => surface,
    })
}

impl Solidity {
    /// What to say beside a place that wants an inside.
    pub(super) fn complaint(&self) -> String {
        debug_assert!(self.body() == Body::Sheet);
        if 0 < self.open_holes {
            let (s, share) = (if self.open_holes == 1 { "" } else { "s" }, 100.0 * self.missing);
            return format!("a Sheet: {} open hole{s}, {share:.2} % of its area", self.open_holes);
        }
        let share = 100.0 * self.odd_share();
        format!("a Sheet: {share:.1} % of test lines cross it an odd number of times")
    }
}

/// A closed form, or a complaint at its argument.
pub(super) fn exact(call: &Call, build: impl Fn(&Call) -> Made) -> Result<Built, Diagnostic> {
    build(call).map(Built::Exact).map_err(|e| complaint(call, e))
}

fn cloud_complaint(call: &Call, what: &str, e: CloudError) -> Diagnostic {
    let usual = "a scan is a PLY file with x, y and z of at least three points that do not lie on a line";
    file_complaint(call.place("source"), what, e, usual)
}

pub(super) fn file_complaint(at: Span, what: &str, e: CloudError, usual: &str) -> Diagnostic {
    let (code, fault) = match e.kind {
        CloudFault::Missing => ("E0601", Fault::Missing),
        CloudFault::Bad => ("E0605", Fault::Input),
        CloudFault::Io => ("E0606", Fault::Io),
    };
    let error = Diagnostic::error(code, format!("{what}: {e}")).at(at, "").fault(fault);
    let usual = match fault {
        Fault::Missing => {
            "names in a scene start from its folder, those given by `-D name=value` from the working directory"
        }
        _ => usual,
    };
    error.help(e.help.unwrap_or_else(|| usual.to_owned()))
}
