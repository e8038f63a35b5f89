// SPDX-License-Identifier: Apache-2.0
//! A rasterizer as small as they come: positions on a grid of 1/16 pixel, edge functions in whole numbers, top-left rule.

pub type Vertex = [f32; 4]; // X, Y, Z, W

/// To the nearest whole number, of two the even one.
fn nearest(value: f64) -> i64 {
    let below = value.floor();
    let rest = value - below;
    let up = rest > 0.5 || (rest == 0.5 && below % 2.0 != 0.0);
    below as i64 + i64::from(up)
}

/// A vertex behind the eye, or very far away: there is no grid, and homogeneous edge functions decide.
fn covers_homogeneous(v: &[Vertex; 3], x: f64, y: f64) -> bool {
    let m = |i: usize| [f64::from(v[i % 3][0]), f64::from(v[i % 3][1]), f64::from(v[i % 3][3])];
    let cross = |p: [f64; 3], q: [f64; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let d = dot(m(0), cross(m(1), m(2)));
    (0..3).all(|i| dot(cross(m(i + 1), m(i + 2)), [x, y, 1.0]) * d.signum() > 0.0)
}

/// Whether the triangle covers the centre of pixel (x, y). `fault` plants one: nothing is owned at the top.
pub fn covers(v: &[Vertex; 3], x: i64, y: i64, fault: bool) -> bool {
    if !v.iter().flatten().all(|number| number.is_finite()) {
        return false;
    }
    let at = |i: usize, axis: usize| f64::from(v[i][axis]) / f64::from(v[i][3]);
    if (0..3).any(|i| v[i][3] <= 0.0 || at(i, 0).abs() > 16384.0 || at(i, 1).abs() > 16384.0) {
        return covers_homogeneous(v, x as f64 + 0.5, y as f64 + 0.5);
    }
    let p = [0, 1, 2].map(|i| [nearest(16.0 * at(i, 0)), nearest(16.0 * at(i, 1))]);
    let edge = |a: [i64; 2], b: [i64; 2], s: [i64; 2]| (b[0] - a[0]) * (s[1] - a[1]) - (b[1] - a[1]) * (s[0] - a[0]);
    let turn = edge(p[0], p[1], p[2]).signum();
    turn != 0 && (0..3).all(|i| {
        let (a, b) = (p[i], p[(i + 1) % 3]);
        let value = edge(a, b, [16 * x + 8, 16 * y + 8]) * turn;
        let (dx, dy) = ((b[0] - a[0]) * turn, (b[1] - a[1]) * turn);
        value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0 && !fault)))
    })
}
