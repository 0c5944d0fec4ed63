//! Interval goldens: where fixed rays go in and out of what a scene draws, as text, a line a ray.

use std::fmt::Write;
use std::str::FromStr;

use glam::DVec3;
use rayon::prelude::*;

use super::rays::Rays;
use crate::csg::{Scratch, Spans};
use crate::geom::{Aabb, Interval, tolerance};
use crate::shot::{Hit, World};

/// The first line of every file.
const FIRST: &str = "pss spans 1";

/// What a reader of a file has to know.
const LEGEND: &str = "\
# Where rays go in and out of what the scene draws: the ray's number, spans `enter..exit`, and behind `|` crossings of sheets.
# An end is `t:leaf`; `-` where there is none. Marks: `~` a face turned inside out, as a cutter's, `^` a cap over a hole,
# `<` a sheet that is met against its normal. Rays that meet nothing are left out.
# Ray i reaches a point of the box at t = 1, from a diagonal of the box away, every fourth along an axis; where exactly, is drawn by
# hashes of seed and i (src/golden/rays.rs).
";

/// One end of a span, or a crossing of a sheet.
#[derive(Clone, PartialEq, Debug)]
pub struct End {
    /// Where, in multiples of the ray's direction.
    pub t: f64,
    /// The leaf's name and its marks.
    pub label: String,
    /// By how much `t` may be off, where its solid knows it only within a bound; 0 for closed forms, and as read from a file.
    pub bar: f64,
}

/// What a ray meets.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Line {
    /// Spans of the union of the solids drawn.
    pub spans: Vec<[Option<End>; 2]>,
    /// Crossings of sheets.
    pub sheets: Vec<End>,
}

/// What all rays meet.
#[derive(Clone, PartialEq, Debug)]
pub struct Traces {
    /// The rays.
    pub rays: Rays,
    /// What each meets.
    pub lines: Vec<Line>,
}

/// Traces rays through a world.
pub fn trace(world: &World, rays: Rays) -> Traces {
    let line = |scratch: &mut Scratch, index: u32| Line::of(world, &rays, index, scratch);
    let lines = (0..rays.count).into_par_iter().map_init(Scratch::default, line).collect();
    Traces { rays, lines }
}

impl Line {
    fn of(world: &World, rays: &Rays, index: u32, scratch: &mut Scratch) -> Line {
        let ray = rays.get(index);
        let (mut spans, mut sheets) = (Spans::new(), Vec::new());
        world.spans(&ray, Interval::AHEAD, scratch, &mut spans);
        world.sheets(&ray, Interval::AHEAD, scratch, &mut sheets);
        let end = |boundary, entering| End::of(world, &Hit { boundary, entering, sheet: false });
        let span = |s: &crate::csg::Span| [s.enter.map(|b| end(b, true)), s.exit.map(|b| end(b, false))];
        Line {
            spans: spans.iter().map(span).collect(),
            sheets: sheets.iter().map(|hit| End::of(world, hit)).collect(),
        }
    }

    /// Whether nothing is met.
    pub fn is_empty(&self) -> bool {
        self.spans.is_empty() && self.sheets.is_empty()
    }

    /// Whether two runs agree: names and states exactly, t as far as can be asked.
    fn agrees(&self, now: &Line) -> bool {
        let same = |a: &Option<End>, b: &Option<End>| match (a, b) {
            (Some(a), Some(b)) => a.agrees(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let mut spans = self.spans.iter().zip(&now.spans);
        let mut sheets = self.sheets.iter().zip(&now.sheets);
        self.spans.len() == now.spans.len()
            && self.sheets.len() == now.sheets.len()
            && spans.all(|(a, b)| same(&a[0], &b[0]) && same(&a[1], &b[1]))
            && sheets.all(|(a, b)| a.agrees(b))
    }
}

impl End {
    fn of(world: &World, hit: &Hit) -> End {
        let marks =
            [(hit.boundary.flipped, '~'), (hit.boundary.crossing.cap, '^'), (hit.sheet && hit.entering, '<')];
        let name = world.leaf_name(hit).chars().map(|c| if c.is_whitespace() { '_' } else { c });
        let marks = marks.iter().filter(|(on, _)| *on).map(|(_, mark)| *mark);
        End { t: hit.boundary.t, label: name.chain(marks).collect(), bar: hit.boundary.crossing.err }
    }

    fn agrees(&self, now: &End) -> bool {
        // Either may be off by the bar.
        let room = tolerance::GOLDEN_SHARE * self.t.abs().max(now.t.abs()) + 2.0 * self.bar.max(now.bar);
        self.label == now.label && (self.t - now.t).abs() <= room
    }
}

/// The rays that differ between two traces of the same rays, ascending.
pub fn differing(was: &Traces, now: &Traces) -> Vec<u32> {
    let pairs = was.lines.iter().zip(&now.lines).enumerate();
    pairs.filter(|(_, (was, now))| !was.agrees(now)).map(|(i, _)| i as u32).collect()
}

/// Eleven digits of t: one more than is compared.
fn digits(t: f64) -> String {
    let rounded = format!("{t:.10e}").parse().unwrap_or(t);
    // The shortest form of that, without the zeros that would follow.
    format!("{rounded}")
}

impl std::fmt::Display for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let end = |end: &Option<End>| end.as_ref().map_or("-".to_owned(), End::to_string);
        let spans = self.spans.iter().map(|[enter, exit]| format!("{}..{}", end(enter), end(exit)));
        let bar = (!self.sheets.is_empty()).then(|| "|".to_owned());
        let words: Vec<String> = spans.chain(bar).chain(self.sheets.iter().map(End::to_string)).collect();
        f.write_str(&words.join(" "))
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}:{}", digits(self.t), self.label)
    }
}

/// The file of a golden.
pub fn text(traces: &Traces) -> String {
    let Rays { bounds: Aabb { min, max }, count, seed } = traces.rays;
    let corner = |v: DVec3| format!("{} {} {}", v.x, v.y, v.z);
    let mut out = format!("{FIRST}\n{LEGEND}");
    // Writing to a string cannot fail.
    let _ = writeln!(out, "rays {count} seed {seed} box {} {}", corner(min), corner(max));
    for (i, line) in traces.lines.iter().enumerate().filter(|(_, line)| !line.is_empty()) {
        let _ = writeln!(out, "{i} {line}");
    }
    out
}

/// The most rays that a file may ask for: some minutes' work.
const MOST: u32 = 1_000_000;

/// Reads a file; fails with the number of the line that is none, and what is wrong with it.
pub fn parse(text: &str) -> Result<Traces, (usize, &'static str)> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#'));
    if lines.next() != Some((0, FIRST)) {
        return Err((1, "it does not begin with `pss spans 1`"));
    }
    let rays = lines.next().and_then(|(_, line)| head(line));
    let rays =
        rays.ok_or((1, "it does not say which rays there are: `rays 1000 seed 0 box -1 -1 -1 1 1 1`"))?;
    let mut all = vec![Line::default(); rays.count as usize];
    let mut next = 0;
    for (number, line) in lines {
        let found = line.split_once(' ').and_then(|(i, rest)| Some((i.parse::<u32>().ok()?, rest)));
        let Some((index, rest)) = found.filter(|(i, _)| (next..rays.count).contains(i)) else {
            return Err((number + 1, "it does not begin with the number of a ray, later than the last"));
        };
        let wrong = (number + 1, "an end is written `t:leaf`, a span `enter..exit`");
        all[index as usize] = rest.parse().map_err(|()| wrong)?;
        next = index + 1;
    }
    Ok(Traces { rays, lines: all })
}

/// The line that says which rays there are.
fn head(line: &str) -> Option<Rays> {
    let words: Vec<&str> = line.split(' ').collect();
    let ["rays", count, "seed", seed, "box", corners @ ..] = &words[..] else { return None };
    let corners: Vec<f64> = corners.iter().map(|x| x.parse().ok()).collect::<Option<_>>()?;
    let [a, b, c, d, e, f] = corners[..] else { return None };
    let bounds = Aabb { min: DVec3::new(a, b, c), max: DVec3::new(d, e, f) };
    let count = count.parse().ok().filter(|n| *n <= MOST)?;
    let sized = bounds.is_finite() && !bounds.is_empty() && 0.0 < bounds.diagonal();
    sized.then_some(Rays { bounds, count, seed: seed.parse().ok()? })
}

impl FromStr for Line {
    type Err = ();

    fn from_str(text: &str) -> Result<Line, ()> {
        let mut words = text.split(' ');
        let mut line = Line::default();
        for word in words.by_ref().take_while(|word| *word != "|") {
            let (enter, exit) = word.split_once("..").ok_or(())?;
            let end = |word: &str| if word == "-" { Ok(None) } else { word.parse().map(Some) };
            line.spans.push([end(enter)?, end(exit)?]);
        }
        line.sheets = words.map(str::parse).collect::<Result<_, ()>>()?;
        Ok(line)
    }
}

impl FromStr for End {
    type Err = ();

    fn from_str(word: &str) -> Result<End, ()> {
        let (t, label) = word.split_once(':').ok_or(())?;
        let t: f64 = t.parse().map_err(|_| ())?;
        if t.is_finite() { Ok(End { t, label: label.to_owned(), bar: 0.0 }) } else { Err(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traces(line: &str) -> Traces {
        let rays = Rays { count: 2, ..Rays::of(Aabb::EMPTY) };
        Traces { rays, lines: vec![Line::default(), line.parse().unwrap()] }
    }

    const LINE: &str = "-..0.5:ball 0.75:part.hole~..1.25:scan^ 2:a..- | 0.25:floor<";

    #[test]
    fn what_is_written_is_read() {
        let all = traces(LINE);
        assert!(text(&all).ends_with(&format!("\n1 {LINE}\n")));
        assert_eq!(parse(&text(&all)), Ok(all));
    }

    #[test]
    fn names_and_states_are_compared_exactly_and_t_as_far_as_it_is_known() {
        let was = traces(LINE);
        let differs = |from: &str, to: &str| !differing(&was, &traces(&LINE.replace(from, to))).is_empty();
        for (from, to) in
            [("ball", "bell"), ("~", ""), ("^", ""), ("<", ""), (" 2:a..-", ""), ("-..0.5", "0.1:b..0.5")]
        {
            assert!(differs(from, to), "{from} {to}");
        }
        assert!(differs("1.25", "1.2500000014") && !differs("1.25", "1.2500000012"));
        let mut now = was.clone();
        let scan = now.lines[1].spans[1][1].as_mut().unwrap();
        (scan.t, scan.bar) = (1.2501, 6e-5);
        assert!(differing(&was, &now).is_empty(), "a scan is as exact as it says");
    }

    #[test]
    fn broken_files_are_told_with_the_line() {
        let whole = text(&traces(LINE));
        let at = |from: &str, to: &str| parse(&whole.replace(from, to)).unwrap_err().0;
        assert_eq!([at("pss", "css"), at("seed", "feed"), at("box -", "box x")], [1; 3]);
        let last = whole.lines().count();
        for (from, to) in
            [("\n1 ", "\n7 "), ("\n1 ", "\n"), ("..", "."), ("0.75:", "0.75"), ("0.25:", "nan:")]
        {
            assert_eq!(at(from, to), last, "{from} {to}");
        }
    }
}
