//! Arguments and their forms. What they mean is left to the commands.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args as Group, Parser, Subcommand, ValueEnum};
use glam::DVec3;
use pss::cloud::ply::Cut;
use pss::geom::Ray;
use pss::output::Format;
use pss::prepare::Options;

/// Renders CSG scenes of scanned point clouds and analytic solids.
#[derive(Parser, Debug)]
#[command(name = "pss", version, max_term_width = 100)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Make a picture of a scene
    Render(RenderArgs),
    /// List where rays go in and out of what a scene draws
    Probe(ProbeArgs),
    /// Say what is wrong, or may be, with scenes: names, types, open scans, geometry; renders nothing
    Check(CheckArgs),
    /// Put scene files into the house style
    Fmt(FmtArgs),
    /// Print a scene as JSON: what was written, and what it comes to
    Dump(DumpArgs),
    /// Evaluate the `expect` items of all scenes of a folder, and compare the goldens beside them
    Test(TestArgs),
    /// Say what a word of the language, or the code of a message, means; without one, list all words
    Explain(ExplainArgs),
    /// Say how far two pictures are apart
    Compare(CompareArgs),
    /// Serve an editor: diagnostics, hover, completion, definitions, formatting
    Lsp(LspArgs),
    /// Say what a cloud of points is like, or convert it
    #[command(subcommand)]
    Cloud(CloudCommand),
}

/// What is done with clouds.
#[derive(Subcommand, Debug)]
pub enum CloudCommand {
    /// Print what the program sees: extent, spacing, noise, widths, normals, holes, Solid or Sheet
    Info(InfoArgs),
    /// Write a cloud as PLY
    Convert(ConvertArgs),
}

/// Arguments of `fmt`.
#[derive(Group, Debug)]
pub struct FmtArgs {
    /// Scene files; `-` is standard input, to standard output
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Change nothing; fail where a file would be changed
    #[arg(long)]
    pub check: bool,
    /// How messages look on standard error
    #[arg(long, value_enum, default_value_t = MessageFormat::Text)]
    pub format: MessageFormat,
}

/// Arguments of `dump`.
#[derive(Group, Debug)]
pub struct DumpArgs {
    /// The scene file; `-` is standard input
    pub scene: PathBuf,
    /// As JSON, the only form there is
    #[arg(long)]
    pub json: bool,
    /// What every command that reads a scene takes.
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Arguments of `test`.
#[derive(Group, Debug)]
pub struct TestArgs {
    /// A folder of scenes, or a scene
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Make goldens of what the scenes are now, where their `expect` items hold: NAME.spans, NAME.exr, NAME.png
    #[arg(long)]
    pub bless: bool,
    /// Write a report for a test server
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// What every command that reads a scene takes.
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Arguments of `explain`.
#[derive(Group, Debug)]
pub struct ExplainArgs {
    /// A word, such as `box`, or a code, such as `E0301`
    pub word: Option<String>,
    /// How messages look on standard error
    #[arg(long, value_enum, default_value_t = MessageFormat::Text)]
    pub format: MessageFormat,
}

/// Arguments of `compare`.
#[derive(Group, Debug)]
pub struct CompareArgs {
    /// A picture, .png or .exr
    pub a: PathBuf,
    /// Another of the same size
    pub b: PathBuf,
    /// How difference is measured: rmse (of the numbers), flip (what an eye sees, 0 to 1) or block (levels of 255 by which some
    /// 3 x 3 pixels are all off to the same side); without it all are printed, and the first decides. Only rmse looks at layers of
    /// EXR files: at each that either has, whole numbers by how many pixels are not the same
    #[arg(long, value_name = "rmse|flip|block", value_parser = crate::compare::metric)]
    pub metric: Option<crate::compare::MetricWord>,
    /// The largest difference that passes, of colour and of each layer; more exits with 1
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = at_most)]
    pub max: Option<f64>,
    /// Write where they differ as a picture: black for nothing, light for the most
    #[arg(long, value_name = "FILE")]
    pub diff: Option<PathBuf>,
    /// How messages look on standard error
    #[arg(long, value_enum, default_value_t = MessageFormat::Text)]
    pub format: MessageFormat,
}

/// A difference, none below zero.
fn at_most(text: &str) -> Result<f64, String> {
    let x: Option<f64> = text.parse().ok();
    x.filter(|x| 0.0 <= *x).ok_or_else(|| "a number from 0 on".to_owned())
}

/// Arguments of `lsp`.
#[derive(Group, Debug)]
pub struct LspArgs {
    /// On standard input and output, the only way there is
    #[arg(long)]
    pub stdio: bool,
    /// Let scenes import files below this folder too
    #[arg(long, value_name = "DIR")]
    pub allow_read: Vec<PathBuf>,
}

/// Arguments of `cloud info`.
#[derive(Group, Debug)]
pub struct InfoArgs {
    /// PLY files
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// One JSON object a file, a line each
    #[arg(long)]
    pub json: bool,
    /// What every command on clouds takes.
    #[command(flatten)]
    pub common: CloudArgs,
}

/// Arguments of `cloud convert`.
#[derive(Group, Debug)]
pub struct ConvertArgs {
    /// The cloud
    pub file: PathBuf,
    /// Where to, .ply
    pub out: PathBuf,
    /// Text instead of binary
    #[arg(long)]
    pub ascii: bool,
    /// Add normals, estimated and oriented, where there are none
    #[arg(long)]
    pub normals: bool,
    /// Only the samples that a surface is made of: merged, without strays
    #[arg(long)]
    pub clean: bool,
    /// What every command on clouds takes.
    #[command(flatten)]
    pub common: CloudArgs,
}

/// What every command on clouds takes.
#[derive(Group, Clone, Copy, Debug)]
pub struct CloudArgs {
    /// Threads; 0 for all cores
    #[arg(short, long, value_name = "N", default_value_t = 0, value_parser = threads)]
    pub threads: usize,
    /// How messages look on standard error
    #[arg(long, value_enum, default_value_t = MessageFormat::Text)]
    pub format: MessageFormat,
    /// Keep the whole points of a file that is cut short, and say so
    #[arg(long)]
    pub lenient: bool,
}

/// What becomes of files that are cut short.
pub fn cut(lenient: bool) -> Cut {
    if lenient { Cut::Kept } else { Cut::Refused }
}

impl Command {
    /// How messages look, and how many threads work.
    pub fn common(&self) -> CloudArgs {
        let of =
            |read: &ReadArgs| CloudArgs { threads: read.threads, format: read.format, lenient: read.lenient };
        match self {
            Command::Render(args) => of(&args.scene.read),
            Command::Probe(args) => of(&args.scene.read),
            Command::Check(args) => of(&args.read),
            Command::Dump(args) => of(&args.read),
            Command::Test(args) => of(&args.read),
            Command::Fmt(FmtArgs { format, .. }) | Command::Explain(ExplainArgs { format, .. }) => {
                CloudArgs { threads: 0, format: *format, lenient: false }
            }
            Command::Compare(args) => CloudArgs { threads: 0, format: args.format, lenient: false },
            Command::Lsp(_) => CloudArgs { threads: 0, format: MessageFormat::Text, lenient: false },
            Command::Cloud(CloudCommand::Info(args)) => args.common,
            Command::Cloud(CloudCommand::Convert(args)) => args.common,
        }
    }
}

/// What every command that reads scenes takes.
#[derive(Group, Debug)]
pub struct ReadArgs {
    /// Set a parameter of the scene
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = define)]
    pub define: Vec<(String, String)>,
    /// Threads; 0 for all cores
    #[arg(short, long, value_name = "N", default_value_t = 0, value_parser = threads)]
    pub threads: usize,
    /// How messages look on standard error
    #[arg(long, value_enum, default_value_t = MessageFormat::Text)]
    pub format: MessageFormat,
    /// Let the scene read files below this folder too
    #[arg(long, value_name = "DIR")]
    pub allow_read: Vec<PathBuf>,
    /// Keep the whole points of scans that are cut short, and say so
    #[arg(long)]
    pub lenient: bool,
}

/// What every command that looks at one scene takes.
#[derive(Group, Debug)]
pub struct SceneArgs {
    /// The scene file; `-` for standard input
    pub scene: PathBuf,
    /// How it is read.
    #[command(flatten)]
    pub read: ReadArgs,
    /// Which of the scene's cameras; the first if none is named
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Size of the whole picture, pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
}

impl SceneArgs {
    /// What they say about the picture.
    pub fn options(&self) -> Options {
        Options { size: self.size, camera: self.camera.clone(), ..Options::default() }
    }
}

/// Arguments of `check`.
#[derive(Group, Debug)]
pub struct CheckArgs {
    /// Scene files; `-` for standard input
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Mend in the scene files what messages have an edit for, then check
    #[arg(long)]
    pub fix: bool,
    /// How they are read.
    #[command(flatten)]
    pub read: ReadArgs,
}

/// How messages look.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum MessageFormat {
    /// For people
    Text,
    /// One JSON object a line
    Json,
}

/// Arguments of `render`.
#[derive(Group, Debug)]
pub struct RenderArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Output, .png or .exr, or `-` for a PNG on standard output; the scene's name with .png if none is given
    #[arg(short, long = "output", value_name = "FILE", value_parser = output)]
    pub output: Vec<PathBuf>,
    /// Rays a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(pss::shot::settings::MAX_SAMPLES)))]
    pub spp: Option<u32>,
    /// The part to make, half-open, pixels from the top left
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    pub crop: Option<[u32; 4]>,
    /// Chooses the noise
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Go on with what a stopped render of the same picture left
    #[arg(long)]
    pub resume: bool,
    /// Stop after so many seconds and keep what there is for `--resume`
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub time_limit: Option<Duration>,
    /// Refuse to write where a file is
    #[arg(long)]
    pub no_clobber: bool,
    /// Say at the end what was done, on standard error
    #[arg(long)]
    pub stats: bool,
    /// Write what was done to a JSON file
    #[arg(long, value_name = "FILE")]
    pub stats_json: Option<PathBuf>,
    /// Write a rule for `make` that says which files the picture depends on
    #[arg(long, value_name = "FILE")]
    pub deps: Option<PathBuf>,
    /// Stay, and make the picture again whenever the scene or a file that it reads changes
    #[arg(long)]
    pub watch: bool,
    /// Draw the picture in the terminal while it is made
    #[arg(long)]
    pub preview: bool,
    /// Show the picture while it is made in a viewer that speaks the protocol of tev
    #[arg(long, value_name = "HOST:PORT")]
    pub display_server: Option<String>,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
    /// How progress is shown on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    pub progress: ProgressMode,
}

/// How progress is shown.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ProgressMode {
    /// A bar on a terminal, else nothing
    Auto,
    /// A line now and then
    Plain,
    /// One JSON object a second
    Json,
    /// Nothing
    None,
}

/// Arguments of `probe`.
#[derive(Group, Debug)]
#[command(group = clap::ArgGroup::new("what").required(true).args(["pixel", "ray", "rays"]))]
pub struct ProbeArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The ray through a pixel's centre
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<[u32; 2]>,
    /// A ray: its origin and its direction
    #[arg(long, value_name = "\"OX,OY,OZ DX,DY,DZ\"", value_parser = ray, allow_hyphen_values = true)]
    pub ray: Option<Ray>,
    /// A file of rays, six numbers a line, comma separated
    #[arg(long, value_name = "FILE.csv")]
    pub rays: Option<PathBuf>,
    /// One line of JSON a ray
    #[arg(long)]
    pub json: bool,
}

/// Whether messages are asked for as JSON, for errors found before the arguments are understood.
pub fn asks_for_json(args: impl Iterator<Item = OsString>) -> bool {
    let args: Vec<OsString> = args.collect();
    let pair = |w: &[OsString]| w[0] == "--format" && w[1] == "json";
    args.iter().any(|a| a == "--format=json") || args.windows(2).any(pair)
}

/// The most threads that can be asked for: more than any machine has, few enough to start.
const MAX_THREADS: usize = 4096;

fn threads(text: &str) -> Result<usize, String> {
    let n: usize = text.parse().map_err(|_| "not a whole number".to_owned())?;
    if n <= MAX_THREADS { Ok(n) } else { Err(format!("at most {MAX_THREADS}")) }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let s: Option<f64> = text.parse().ok();
    s.and_then(|s| Duration::try_from_secs_f64(s).ok()).ok_or_else(|| "a number of seconds".to_owned())
}

fn define(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.to_owned())),
        _ => Err("write it as name=value".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    match numbers(text, 'x') {
        Ok(size) if !size.contains(&0) => Ok(size),
        _ => Err("write it as WxH, such as 800x600".to_owned()),
    }
}

fn crop(text: &str) -> Result<[u32; 4], String> {
    let [x0, y0, x1, y1] = numbers(text, ',')?;
    if x0 < x1 && y0 < y1 { Ok([x0, y0, x1, y1]) } else { Err("it holds no pixel".to_owned()) }
}

fn pixel(text: &str) -> Result<[u32; 2], String> {
    numbers(text, ',')
}

fn numbers<const N: usize>(text: &str, separator: char) -> Result<[u32; N], String> {
    let wrong = || format!("not {N} whole numbers with `{separator}` between them");
    let list: Vec<u32> =
        text.split(separator).map(|s| s.trim().parse()).collect::<Result<_, _>>().map_err(|_| wrong())?;
    list.try_into().map_err(|_| wrong())
}

fn output(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if text == "-" || Format::of(&path).is_some() {
        Ok(path)
    } else {
        Err("the name does not end in .png or .exr".to_owned())
    }
}

/// A ray from six numbers with commas or spaces between them.
pub fn ray(text: &str) -> Result<Ray, String> {
    let wrong = || "not six numbers, ox,oy,oz dx,dy,dz".to_owned();
    let parts = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|s| !s.is_empty());
    let list: Vec<f64> = parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
    let [ox, oy, oz, dx, dy, dz] = list[..] else { return Err(wrong()) };
    let ray = Ray::new(DVec3::new(ox, oy, oz), DVec3::new(dx, dy, dz));
    if ray.is_valid() {
        Ok(ray)
    } else {
        Err("a ray has a direction, and numbers with which one can count: up to 1e150".to_owned())
    }
}
