//! Clouds to PLY: binary little-endian or text; doubles where floats would lose digits.

use std::io::{self, Write};

use super::super::{Cloud, is_single};

/// How a cloud is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Encoding {
    /// Binary, little-endian.
    Binary,
    /// Text, numbers with as many digits as reading back the same bits needs.
    Text,
}

/// Writes positions, and normals and colours where there are any. Reading the file gives the same positions to the bit,
/// the same normals to rounding, and colours, which are stored as eight bits of sRGB, to one part in 255.
pub fn write(cloud: &Cloud, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    let wide = !is_single(&cloud.points);
    let kind = if wide { "double" } else { "float" };
    let format = if encoding == Encoding::Binary { "binary_little_endian" } else { "ascii" };
    writeln!(out, "ply\nformat {format} 1.0\nelement vertex {}", cloud.points.len())?;
    let mut columns = |names: &[&str], kind: &str| -> io::Result<()> {
        names.iter().try_for_each(|name| writeln!(out, "property {kind} {name}"))
    };
    columns(&["x", "y", "z"], kind)?;
    if cloud.normals.is_some() {
        columns(&["nx", "ny", "nz"], kind)?;
    }
    if cloud.colors.is_some() {
        columns(&["red", "green", "blue"], "uchar")?;
    }
    writeln!(out, "end_header")?;
    for i in 0..cloud.points.len() {
        let normal = cloud.normals.iter().flat_map(|n| n[i].to_array());
        let numbers = cloud.points[i].to_array().into_iter().chain(normal);
        let colors = cloud.colors.iter().flat_map(|c| c[i].map(eight_bits));
        match encoding {
            Encoding::Binary => {
                for x in numbers {
                    if wide {
                        out.write_all(&x.to_le_bytes())?
                    } else {
                        out.write_all(&(x as f32).to_le_bytes())?
                    }
                }
                out.write_all(&colors.collect::<Vec<u8>>())?;
            }
            Encoding::Text => {
                let number = |x: f64| if wide { x.to_string() } else { (x as f32).to_string() };
                let words: Vec<String> = numbers.map(number).chain(colors.map(|c| c.to_string())).collect();
                writeln!(out, "{}", words.join(" "))?;
            }
        }
    }
    Ok(())
}

/// The sRGB byte of a linear component.
fn eight_bits(linear: f32) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let srgb = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (srgb * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn round_trip(cloud: &Cloud, encoding: Encoding) -> Cloud {
        let mut bytes = Vec::new();
        write(cloud, encoding, &mut bytes).unwrap();
        super::super::read(&bytes).unwrap()
    }

    #[test]
    fn what_is_written_is_read_back() {
        let third = DVec3::new(1.0 / 3.0, -2e7, 1e-9);
        for points in [
            vec![DVec3::new(0.5, 2.0, -0.25), DVec3::Y, DVec3::Z],
            vec![third, 3e7 * DVec3::X, 1e7 * DVec3::Z],
        ] {
            for encoding in [Encoding::Binary, Encoding::Text] {
                let normals = Some(vec![DVec3::X, -DVec3::Y, DVec3::Z]);
                let cloud = Cloud { points: points.clone(), normals, ..Cloud::default() };
                let back = round_trip(&cloud, encoding);
                assert_eq!((back.points, back.normals), (cloud.points, cloud.normals));
            }
        }
    }

    #[test]
    fn every_byte_of_a_colour_survives() {
        let points: Vec<DVec3> =
            (0..256).map(|i| DVec3::new(f64::from(i % 16), f64::from(i / 16), 0.0)).collect();
        let colors = (0..256).map(|i| [i as f32 / 255.0, 0.0, 1.0]).collect();
        let once = round_trip(&Cloud { points, colors: Some(colors), ..Cloud::default() }, Encoding::Binary);
        let twice = round_trip(&once, Encoding::Text);
        assert_eq!(once.colors, twice.colors);
    }
}
