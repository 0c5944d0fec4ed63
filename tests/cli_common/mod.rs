//! The binary, run in a folder of its own, and clouds to feed it.
#![allow(dead_code, missing_docs)]

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use glam::DVec3;

/// A folder that goes away, with a way to run the program in it.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Folder {
        fs::write(self.path().join(name), bytes).unwrap();
        self
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path().join(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub fn files(&self) -> Vec<String> {
        let name = |e: std::io::Result<fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
        let mut names: Vec<String> = fs::read_dir(self.path()).unwrap().map(name).collect();
        names.sort();
        names
    }

    /// The same with at most so many bytes of address space.
    #[cfg(target_os = "linux")]
    pub fn run_within(&self, bytes: u64, args: &[&str]) -> Ran {
        let limited = format!("ulimit -v {} && exec \"$0\" \"$@\"", bytes >> 10);
        let program = ["-c", &limited, env!("CARGO_BIN_EXE_pss")];
        let output = Command::new("sh").args(program).args(args).current_dir(self.path()).output();
        Ran::of(output.unwrap())
    }

    pub fn run(&self, args: &[&str]) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_pss")).args(args).current_dir(self.path()).output();
        Ran::of(output.unwrap())
    }
}

/// What a run came to.
#[derive(Debug)]
pub struct Ran {
    pub code: i32,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Ran {
    fn of(output: Output) -> Ran {
        let stderr = String::from_utf8(output.stderr).unwrap();
        Ran { code: output.status.code().unwrap(), stdout: output.stdout, stderr }
    }

    /// Standard output as lines of JSON.
    pub fn json_lines(&self) -> Vec<serde_json::Value> {
        let text = std::str::from_utf8(&self.stdout).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

/// Width and height that a PNG says it has.
pub fn png_size(bytes: &[u8]) -> [u32; 2] {
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "no PNG");
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    [word(16), word(20)]
}

/// The unit sphere in `n` even samples, those above `top` left out: a hole as wide as it is.
pub fn sphere(n: usize, top: f64) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z)
    };
    (0..n).map(point).filter(|p| p.z <= top).collect()
}

/// A PLY of points without normals.
pub fn ply(points: &[DVec3]) -> String {
    let rows = points.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z));
    ply_of(points.len(), "property float x\nproperty float y\nproperty float z\n", rows)
}

/// A PLY of points of the unit sphere with their normals.
pub fn ply_with_normals(points: &[DVec3]) -> String {
    let columns = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let rows = points.iter().map(|p| format!("{0} {1} {2} {0} {1} {2}", p.x, p.y, p.z));
    ply_of(points.len(), &columns, rows)
}

/// A PLY of rows of text.
pub fn ply_of(count: impl std::fmt::Display, columns: &str, rows: impl Iterator<Item = String>) -> String {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {count}\n{columns}end_header\n");
    for row in rows {
        writeln!(text, "{row}").unwrap();
    }
    text
}
