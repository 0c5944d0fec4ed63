mod common;
use common::*;
use glam::DVec3;
use pss::solid::point_set::*;
#[test]
fn probe() {
    let (p, n) = Truth::Slab.cloud(10_000);
    let set = surface(&p, &n, &Options::default());
    let mut fs = FieldScratch::default();
    let o = DVec3::new(0.32098607568750265, 0.36980163944882105, 0.07603016981539829);
    let d = DVec3::new(-1.4559540308097594, -2.771374617413039, 0.06499034033393386);
    for i in 0..50 {
        let t = 0.4552 + 0.00001 * i as f64;
        let q = o + d * t;
        let f = set.field(q, &mut fs);
        println!(
            "{t:.6} z {:.6} w {:?} {:?}",
            q.z,
            set.width_at(q),
            f.map(|f| (f.value, f.gradient, f.kept, f.drift))
        );
    }
    let o = DVec3::new(0.4066410043671973, -0.21176303936853408, 1.497043602013534);
    let d = DVec3::new(-0.49028081712457455, -0.22867414709373346, -2.997082389501757);
    let mut s = pss::solid::Scratch::default();
    println!("{:?}", all(&set, &pss::geom::Ray::new(o, d), &mut s));
    println!("{:?}", s.counts);
}
