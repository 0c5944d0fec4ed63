//! placeholder until merge
use glam::{DMat3, DVec3};
/// eigen
pub fn symmetric3(m: DMat3) -> (DVec3, DMat3) {
    let mut a = m;
    let mut v = DMat3::IDENTITY;
    for _ in 0..30 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let apq = a.col(q)[p];
            if apq == 0.0 {
                continue;
            }
            let th = (a.col(q)[q] - a.col(p)[p]) / (2.0 * apq);
            let t = th.signum() / (th.abs() + (th * th + 1.0).sqrt());
            let t = if th == 0.0 { 1.0 } else { t };
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut r = DMat3::IDENTITY;
            r.col_mut(p)[p] = c;
            r.col_mut(q)[q] = c;
            r.col_mut(q)[p] = s;
            r.col_mut(p)[q] = -s;
            a = r.transpose() * a * r;
            v = v * r;
        }
    }
    let mut i = [0, 1, 2];
    i.sort_by(|&x, &y| a.col(x)[x].total_cmp(&a.col(y)[y]));
    (
        DVec3::new(a.col(i[0])[i[0]], a.col(i[1])[i[1]], a.col(i[2])[i[2]]),
        DMat3::from_cols(v.col(i[0]), v.col(i[1]), v.col(i[2])),
    )
}
