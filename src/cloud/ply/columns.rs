//! The columns that mean something (positions, normals, colours), gathered row by row into a cloud.

use glam::DVec3;

use super::header::{Element, Encoding, Scalar};
use crate::cloud::{Cloud, CloudError};

/// What a column is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Nothing.
    Ignored,
    /// One of [`NAMES`].
    Slot(u8),
}

/// The columns that are read, with their second names; each group of three belongs together.
const NAMES: [[&str; 2]; 9] = [
    ["x", "x"],
    ["y", "y"],
    ["z", "z"],
    ["nx", "normal_x"],
    ["ny", "normal_y"],
    ["nz", "normal_z"],
    ["red", "diffuse_red"],
    ["green", "diffuse_green"],
    ["blue", "diffuse_blue"],
];

/// A cloud of which a larger share of values is not finite, or which spans more than [`SPAN`], was
/// read in the wrong byte order: a swapped `f32` of ordinary size has a random exponent.
const NON_FINITE_SHARE: f64 = 0.5;
/// See [`NON_FINITE_SHARE`]; a length that no scan has.
const SPAN: f64 = 1e30;

/// Rows on their way to a cloud.
pub struct Columns {
    roles: Vec<Role>,
    row: [f64; 9],
    color_scale: Option<ColorScale>,
    cloud: Cloud,
    first_dropped: u64,
    bad_normals: usize,
    wide_colors: bool,
}

/// How stored colours become linear ones.
#[derive(Clone, Copy, PartialEq, Debug)]
enum ColorScale {
    /// Linear already, 0..1.
    Linear,
    /// sRGB, the white being this number.
    Srgb(f32),
}

impl Columns {
    /// Finds the columns of `vertex`.
    pub fn new(vertex: &Element) -> Result<Columns, CloudError> {
        let find = |slot: usize| {
            NAMES[slot].iter().find_map(|name| vertex.properties.iter().position(|p| p.name == *name))
        };
        let scalar = |slot: usize| find(slot).filter(|&p| vertex.properties[p].list.is_none());
        for (slot, [name, _]) in NAMES.iter().enumerate().take(3) {
            let Some(at) = find(slot) else {
                let message = format!("`vertex` has no property `{name}`");
                return Err(CloudError::bad(message).at_line(vertex.line).help("points need x, y and z"));
            };
            if vertex.properties[at].list.is_some() {
                let message = format!("property `{name}` is a list");
                return Err(CloudError::bad(message)
                    .at_line(vertex.properties[at].line)
                    .help("a coordinate is one number"));
            }
        }
        let mut roles = vec![Role::Ignored; vertex.properties.len()];
        let mut has = [false; 3];
        for (group, has) in has.iter_mut().enumerate() {
            let found: Vec<usize> = (3 * group..3 * group + 3).filter_map(scalar).collect();
            *has = found.len() == 3;
            if *has {
                found.iter().zip(3 * group as u8..).for_each(|(&at, slot)| roles[at] = Role::Slot(slot));
            }
        }
        let scale = |at: usize| match vertex.properties[at].scalar {
            Scalar::F32 | Scalar::F64 => ColorScale::Linear,
            Scalar::U16 => ColorScale::Srgb(65535.0),
            _ => ColorScale::Srgb(255.0),
        };
        Ok(Columns {
            roles,
            row: [0.0; 9],
            color_scale: scalar(6).filter(|_| has[2]).map(scale),
            cloud: Cloud {
                normals: has[1].then(Vec::new),
                colors: has[2].then(Vec::new),
                ..Cloud::default()
            },
            first_dropped: 0,
            bad_normals: 0,
            wide_colors: false,
        })
    }

    /// What the `at`-th property of the element is for.
    pub fn role(&self, at: usize) -> Role {
        self.roles[at]
    }

    /// Makes room for `count` rows, exactly.
    pub fn reserve(&mut self, count: usize) {
        self.cloud.points.reserve_exact(count);
        self.cloud.normals.iter_mut().for_each(|v| v.reserve_exact(count));
        self.cloud.colors.iter_mut().for_each(|v| v.reserve_exact(count));
    }

    /// Sets a value of the row.
    pub fn set(&mut self, slot: u8, value: f64) {
        self.row[usize::from(slot)] = value;
    }

    /// Ends the row, which is the `index`-th of the file.
    pub fn push(&mut self, index: u64) {
        let [x, y, z, nx, ny, nz, colors @ ..] = self.row;
        let p = DVec3::new(x, y, z);
        if !p.is_finite() {
            if self.cloud.dropped == 0 {
                self.first_dropped = index;
            }
            self.cloud.dropped += 1;
            return;
        }
        // Adding zero turns -0 into 0, so that equal positions have equal bits.
        self.cloud.points.push(p + DVec3::ZERO);
        if let Some(normals) = &mut self.cloud.normals {
            let normal = unit(DVec3::new(nx, ny, nz));
            self.bad_normals += usize::from(normal == DVec3::ZERO);
            normals.push(normal);
        }
        if let (Some(list), Some(scale)) = (&mut self.cloud.colors, self.color_scale) {
            let colors = colors.map(|c| c as f32);
            self.wide_colors |= scale == ColorScale::Linear && colors.iter().any(|&c| 1.0 < c);
            list.push(match scale {
                ColorScale::Linear => colors.map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 }),
                ColorScale::Srgb(white) => colors.map(|c| linear(c / white)),
            });
        }
    }

    /// The cloud of all rows.
    pub fn finish(self, encoding: Encoding) -> Result<Cloud, CloudError> {
        let mut cloud = self.cloud;
        let total = cloud.points.len() as u64 + cloud.dropped;
        let bounds = crate::geom::Aabb::of_points(cloud.points.iter().copied());
        let wild = NON_FINITE_SHARE * (total as f64) < cloud.dropped as f64 || SPAN < bounds.diagonal();
        if wild && encoding != Encoding::Ascii {
            return Err(CloudError::bad(
                "most coordinates are not finite or absurdly large: wrong byte order?",
            )
            .help("compare the `format` line with the program that wrote the file"));
        }
        if cloud.points.is_empty() {
            let message = format!("no points: none of the {total} rows has finite coordinates");
            return Err(CloudError::bad(message).help("export the cloud again"));
        }
        if 0 < cloud.dropped {
            let (n, first) = (cloud.dropped, self.first_dropped);
            cloud.notes.push(format!(
                "{n} points with coordinates that are not finite were dropped, the first is point {first}"
            ));
        }
        if 0 < self.bad_normals {
            cloud
                .notes
                .push(format!("{} normals are zero or not finite and count as missing", self.bad_normals));
        }
        if let (true, Some(colors)) = (self.wide_colors, &mut cloud.colors) {
            // Floats of 0..255: some exporters keep the numbers and change the type.
            colors.iter_mut().for_each(|c| *c = c.map(|v| linear(v / 255.0)));
            cloud.notes.push("colours are floats above 1 and were read as 0..255".to_string());
        }
        Ok(cloud)
    }
}

/// `v` with length 1, zero where it is zero or not finite; scaled first, so that no square overflows.
fn unit(v: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    if v.is_finite() && 0.0 < largest { (v / largest).normalize() } else { DVec3::ZERO }
}

/// The sRGB curve (IEC 61966-2-1), from 0..1 to linear 0..1.
fn linear(encoded: f32) -> f32 {
    let c = if encoded.is_finite() { encoded.clamp(0.0, 1.0) } else { 0.0 };
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}
