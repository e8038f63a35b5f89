// SPDX-License-Identifier: Apache-2.0
//! Holds raster.rs against vectors/coverage_grid4.txt: every test is right, or the fault is named.
//! run coverage_grid4.txt coverage_grid4.faults.txt [--fault]
use std::{collections::HashSet, env, fs, process};

mod raster;

/// The words of a line, as numbers.
struct Words<'a>(std::str::SplitWhitespace<'a>);
impl Words<'_> {
    fn whole(&mut self) -> usize {
        self.0.next().expect("a word").parse().expect("a whole number")
    }
    fn float(&mut self) -> f32 {
        f32::from_bits(u32::from_str_radix(self.0.next().expect("a word"), 16).expect("bits"))
    }
    fn plane(&mut self) -> Vec<usize> {
        (0..self.whole()).flat_map(|_| { let run = self.whole(); vec![self.whole(); run] }).collect()
    }
}

fn main() {
    let arguments: Vec<String> = env::args().collect();
    let read = |n: usize| fs::read_to_string(&arguments[n]).expect("a file");
    let (mut failed, mut tests) = (HashSet::new(), 0);
    for line in read(1).lines() {
        let mut words = Words(line.split_whitespace());
        let head: Vec<usize> = (0..18).map(|_| words.whole()).collect(); // id, words, models, width, height, samples, ..., frames
        let pixels: Vec<_> = (head[13]..head[15]).flat_map(|y| (head[12]..head[14]).map(move |x| (x as i64, y as i64))).collect();
        let mut counts = vec![0; pixels.len()];
        words.whole(); // no initial depth
        for _ in 0..words.whole() {
            (0..11).for_each(|_| { words.whole(); }); // the state is the default; first index
            let vertices: Vec<raster::Vertex> = (0..words.whole()).map(|_| [0; 4].map(|_| words.float())).collect();
            for _ in 0..words.whole() {
                let triangle = [0; 3].map(|_| vertices[words.whole()]);
                for (count, (x, y)) in counts.iter_mut().zip(&pixels) {
                    *count += usize::from(raster::covers(&triangle, *x, *y, arguments.len() > 3));
                }
            }
            (words.whole(), words.whole()); // no identifiers, no attributes
        }
        let (least, most) = (words.plane(), words.plane());
        if (0..counts.len()).any(|s| counts[s] < least[s] || counts[s] > most[s]) {
            failed.insert(head[0]);
        }
        tests += 1;
    }
    println!("{tests} tests, {} wrong", failed.len());
    let score = |line: &str| { // of the tests that failed or show this fault, the share that did both
        let shown: HashSet<usize> = line.split(' ').skip(1).map(|id| id.parse().expect("an id")).collect();
        (1000 * shown.intersection(&failed).count()).checked_div(shown.union(&failed).count()).unwrap_or(0)
    };
    let faults = read(2);
    if let Some(fault) = faults.lines().filter(|_| !failed.is_empty()).max_by_key(|line| score(line)) {
        println!("likely: {}", fault.split(' ').next().unwrap());
        process::exit(1);
    }
}
