//! The tiles of a picture.

/// Side of a tile, pixels: rays of a tile stay close together, and 800 x 600 pixels still give every thread of
/// a large machine several tiles.
pub const SIDE: u32 = 32;

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

    /// Smaller tiles that make it up, whose rays mostly meet the same few things; they start at multiples of their side in the
    /// whole picture.
    pub fn parts(self) -> impl Iterator<Item = Tile> {
        let [w, h] = self.size;
        cells([self.x, self.y, self.x + w, self.y + h], PART)
    }

    /// The whole tile, of a picture of a size, of which this one is what a crop left.
    pub fn uncropped(&self, size: [u32; 2]) -> Tile {
        let [x, y] = [self.x, self.y].map(|at| at / SIDE * SIDE);
        Tile { x, y, size: [SIDE.min(size[0] - x), SIDE.min(size[1] - y)] }
    }

    /// Its pixels, row by row.
    pub fn each(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Tile { x, y, size: [w, h] } = *self;
        (y..y + h).flat_map(move |y| (x..x + w).map(move |x| [x, y]))
    }

    /// Where a pixel of it stands in that order.
    pub fn index(&self, [x, y]: [u32; 2]) -> usize {
        (y - self.y) as usize * self.size[0] as usize + (x - self.x) as usize
    }

    /// Whether it has a pixel.
    pub fn has(&self, [x, y]: [u32; 2]) -> bool {
        (self.x..self.x + self.size[0]).contains(&x) && (self.y..self.y + self.size[1]).contains(&y)
    }
}

/// Tiles that cover a window `[x0, y0, x1, y1]`, row by row. They start at multiples of the side in the whole
/// picture, so that a cropped picture has the tiles of the whole one.
pub fn cover(window: [u32; 4]) -> Vec<Tile> {
    cells(window, SIDE).collect()
}

/// The squares of a grid that cover a window, cut to it.
fn cells([x0, y0, x1, y1]: [u32; 4], side: u32) -> impl Iterator<Item = Tile> {
    let rows = y0 / side..y1.div_ceil(side);
    rows.flat_map(move |row| (x0 / side..x1.div_ceil(side)).map(move |column| [column, row])).map(
        move |[column, row]| {
            let (x, y) = ((column * side).max(x0), (row * side).max(y0));
            let end = |cell: u32, limit: u32| ((cell + 1).saturating_mul(side)).min(limit);
            Tile { x, y, size: [end(column, x1) - x, end(row, y1) - y] }
        },
    )
}

/// How many tiles [`cover`] gives.
pub fn count([x0, y0, x1, y1]: [u32; 4]) -> u64 {
    let cells = |from: u32, to: u32| if from < to { u64::from(to.div_ceil(SIDE) - from / SIDE) } else { 0 };
    cells(x0, x1) * cells(y0, y1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let window = [5, 31, 100, 65];
        assert_eq!(count(window), cover(window).len() as u64);
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
