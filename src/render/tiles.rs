//! The tiles of a picture.

/// Side of a tile, pixels: rays of a tile stay close together, and 800 x 600 pixels still give every thread of
/// a large machine several tiles.
const SIDE: u32 = 32;

/// Side of the parts of a tile, pixels.
const PART: u32 = 8;

/// A rectangle of pixels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Tile {
    /// First column, from the left of the whole picture.
    pub x: u32,
    /// First row, from the top of the whole picture.
    pub y: u32,
    /// Width and height.
    pub size: [u32; 2],
}

impl Tile {
    /// How many pixels it has.
    pub fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Smaller tiles that make it up, whose rays mostly meet the same few things.
    pub fn parts(self) -> impl Iterator<Item = Tile> {
        let [w, h] = self.size;
        let rows = (0..h).step_by(PART as usize);
        rows.flat_map(move |y| (0..w).step_by(PART as usize).map(move |x| (x, y))).map(move |(x, y)| Tile {
            x: self.x + x,
            y: self.y + y,
            size: [PART.min(w - x), PART.min(h - y)],
        })
    }
}

/// Tiles that cover a window `[x0, y0, x1, y1]`, row by row. They start at multiples of the side in the whole
/// picture, so that a cropped picture has the tiles of the whole one.
pub fn cover([x0, y0, x1, y1]: [u32; 4]) -> Vec<Tile> {
    let mut tiles = Vec::new();
    for row in y0 / SIDE..y1.div_ceil(SIDE) {
        for column in x0 / SIDE..x1.div_ceil(SIDE) {
            let (x, y) = ((column * SIDE).max(x0), (row * SIDE).max(y0));
            let end = |cell: u32, limit: u32| ((cell + 1).saturating_mul(SIDE)).min(limit);
            tiles.push(Tile { x, y, size: [end(column, x1) - x, end(row, y1) - y] });
        }
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let window = [5, 31, 100, 65];
        let mut seen = vec![0; 100 * 65];
        for tile in cover(window).into_iter().flat_map(Tile::parts) {
            for y in tile.y..tile.y + tile.size[1] {
                for x in tile.x..tile.x + tile.size[0] {
                    seen[(y * 100 + x) as usize] += 1;
                }
            }
        }
        for y in 0..65 {
            for x in 0..100 {
                assert_eq!(seen[y * 100 + x], i32::from(5 <= x && 31 <= y), "{x} {y}");
            }
        }
    }
}
