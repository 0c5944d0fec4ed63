//! The scenes: three with noise in few places, as pictures of things mostly have it, and two with noise nearly everywhere.

use pss::prepare::{self, Options};
use pss::shot::Shot;
use pss::source::SourceMap;

/// Names and texts.
pub const SCENES: [(&str, &str); 5] =
    [("sun", SUN), ("lens", LENS), ("glass", GLASS), ("cut", CUT), ("lamp", LAMP)];

/// A cut body on a floor in a soft sun: noise in half-shadows and on edges alone.
const SUN: &str = "
draw (sphere(r: 1, at: [0, 0, 1]) - box([0, -2, 0.6], [2, 0, 3])).with(matte(#c08040))
draw torus(major: 0.5, minor: 0.15, at: [1.6, 0.4, 0.15]).with(matte(#60a060))
draw plane(z: 0)
camera(eye: [2.5, -5, 3], look_at: [0, 0, 0.7], fov: 34deg)
light sun(direction: [-1, 2, -3], intensity: 1.5, softness: 4deg)
render(size: [96, 72], integrator: \"direct\", tone: \"none\")";

/// Pegs in a row, one in focus: noise where the lens blurs.
const LENS: &str = "
draw union(for i in 0..7 { cylinder(r: 0.2, h: 1).move([0.55 * i - 1.6, 1.2 * i - 2, 0]) }).with(matte(#b05040))
draw plane(z: 0)
camera(eye: [0, -6, 1.6], look_at: [0, 0, 0.4], fov: 40deg, aperture: 0.12, focus: 6)
light sun(direction: [-1, 2, -3], intensity: 1.5)
render(size: [96, 72], integrator: \"direct\", tone: \"none\")";

/// A cut body on a floor under a sky and a soft sun: noise in half-shadows alone.
const CUT: &str = "
material red(kind: \"plastic\", color: #c04030, roughness: 0.2)
draw (sphere(r: 1, at: [0, 0, 1]).with(red) - box([0, -2, 0.6], [2, 0, 3]).with(matte(#f2e3c6)))
draw plane(z: 0)
camera(eye: [2.5, -5, 3], look_at: [0, 0, 0.7], fov: 34deg)
light sun(direction: [-1, 2, -3], intensity: 1.5, softness: 3deg)
light sky(color: #dfe8ff, intensity: 0.5)
render(size: [96, 72], integrator: \"direct\", tone: \"none\")";

/// A glass ball and a metal one before the open sky.
const GLASS: &str = "
draw sphere(r: 0.8, at: [-0.9, 0, 0]).with(glass(#d8f0e8, depth: 3))
draw sphere(r: 0.8, at: [0.9, 0, 0]).with(metal(#e6b860, roughness: 0.3))
camera(eye: [0, -7, 1], look_at: [0, 0, 0], fov: 36deg)
light lamp(at: [-3, -3, 5], size: [2, 2], look_at: [0, 0, 0], intensity: 20)
light sky(color: #90a8d0, intensity: 0.5)
render(size: [96, 72], integrator: \"path\", tone: \"none\")";

/// A room lit by a lamp behind a screen: deep shadows beside bright walls.
const LAMP: &str = "
draw (box([-3, -9, -1], [3, 4, 4]) - box([-2, -8, 0], [2, 3, 3])).with(matte(#d0c8b8))
draw box([-1, 1, 0], [-0.9, 2.5, 2.4]).with(matte(#a05040))
draw sphere(r: 0.5, at: [0.8, 1, 0.5]).with(plastic(#4060a0, roughness: 0.1))
camera(eye: [0, -6, 1.5], look_at: [0, 1, 1.3], fov: 40deg)
light lamp(at: [-1.5, 2, 2.9], size: [0.5, 0.5], look_at: [-1.5, 2, 0], intensity: 5)
render(size: [96, 72], integrator: \"path\", tone: \"none\")";

/// A scene, prepared.
pub fn shot(text: &str) -> Shot {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text.to_owned());
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).expect("a scene");
    prepare::prepare(&scene, &Options::default()).expect("a shot").shot
}
