//! A drawing as pixels.

use std::path::Path;

/// Writes an SVG as a PNG. A machine without fonts gets a picture without words.
pub fn write(svg: &str, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut options = resvg::usvg::Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_system_fonts();
    let family = |f: &resvg::usvg::fontdb::FaceInfo| f.families.first().map(|(name, _)| name.clone());
    let plain = fonts.faces().filter_map(family).filter(|name| name.contains("Sans")).min();
    if let Some(name) = plain.or_else(|| fonts.faces().filter_map(family).min()) {
        fonts.set_sans_serif_family(name);
    }
    let tree = resvg::usvg::Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size();
    let mut image =
        resvg::tiny_skia::Pixmap::new(size.width(), size.height()).ok_or("no room for the plot")?;
    resvg::render(&tree, resvg::tiny_skia::Transform::identity(), &mut image.as_mut());
    std::fs::write(path, image.encode_png()?)?;
    Ok(())
}
