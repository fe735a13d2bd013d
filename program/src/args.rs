//! The command line: subcommands, options, and their help.

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use holefill::{FillOptions, Method};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

/// Fills holes in triangle meshes. The rest of the mesh stays as it is.
#[derive(Debug, Parser)]
#[command(name = "holefill", version, after_help = EXIT_STATUS)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "\
The extension of a file tells its format: .ply, .obj, .off or .stl.
Exit status: 0 done; 1 a file cannot be read or written; 2 bad usage; 3 some holes could not be filled
(the output has the others filled).";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fill the holes of a mesh
    Fill(FillArgs),
    /// Make a mesh from points
    Points(PointsArgs),
    /// List the boundary loops of a mesh
    Inspect(InspectArgs),
    /// Measure the distance between two meshes
    Compare(CompareArgs),
    /// Make a damaged model, fill it, and draw a picture of both
    Demo(DemoArgs),
}

#[derive(Debug, Args)]
pub(crate) struct FillArgs {
    /// Mesh to fill
    pub(crate) input: PathBuf,
    /// Filled mesh: the elements of INPUT, unchanged and in order, then the new ones.
    /// Written completely or not at all; may be INPUT itself, which is then replaced
    #[arg(short, long, verbatim_doc_comment)]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) how: FillHow,
    /// Number of threads, at most 1024; 0 takes one for each processor.
    /// The result does not depend on it
    #[arg(
        long,
        allow_negative_numbers = true,
        verbatim_doc_comment,
        value_name = "N",
        default_value_t = 0,
        value_parser = clap::value_parser!(u16).range(..=1024)
    )]
    pub(crate) threads: u16,
    /// Also write a report of each hole, as JSON (seconds, degrees)
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Also draw the mesh before and after, patches in orange
    #[arg(long, value_name = "FILE.png")]
    pub(crate) preview: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Which holes are filled, and how.
#[derive(Debug, Default, Args)]
pub(crate) struct FillHow {
    /// How to fill; the methods are listed below
    #[arg(long, value_name = "NAME", default_value_t, value_parser = Method::from_str)]
    pub(crate) method: Method,
    /// Leave the loop through this boundary edge open; can be repeated. The edge runs
    /// from vertex V0 to V1 (counted from 0) as in its triangle; see `holefill inspect`
    #[arg(long, value_name = "V0,V1", value_parser = parse_edge, verbatim_doc_comment)]
    pub(crate) keep: Vec<[u32; 2]>,
    /// Fill only the loop through this edge; can be repeated [default: every loop]
    #[arg(long = "loop", value_name = "V0,V1", value_parser = parse_edge)]
    pub(crate) only: Vec<[u32; 2]>,
    /// Leave loops with more than N edges open [default: no limit]
    #[arg(long, allow_negative_numbers = true, value_name = "N")]
    pub(crate) max_edges: Option<usize>,
    /// Leave loops longer than L open, in units of the file [default: no limit]
    #[arg(long, allow_negative_numbers = true, value_name = "L")]
    pub(crate) max_perimeter: Option<f64>,
    /// Leave the N loops of the largest perimeter open
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "N",
        default_value_t = 0
    )]
    pub(crate) keep_largest: usize,
    /// Set a parameter; can be repeated; the parameters are listed below
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_setting)]
    pub(crate) set: Vec<(String, String)>,
    /// Seed for methods that use random numbers
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "N",
        default_value_t = 0
    )]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct PointsArgs {
    /// Points: a .ply file (with or without normals and colors), a .xyz or .txt file (3, 6 or 9
    /// numbers a line: position, normal, color), or the vertices of a .obj, .off or .stl file
    #[arg(verbatim_doc_comment)]
    pub(crate) input: PathBuf,
    /// Mesh: the points of INPUT, unchanged and in order, with triangles.
    /// Written completely or not at all; may be INPUT itself, which is then replaced
    #[arg(short, long, verbatim_doc_comment)]
    pub(crate) output: PathBuf,
    /// Largest radius of the circle through the corners of a triangle, in units of the
    /// file; larger holes stay open [default: from the spacing of the points]
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "R",
        value_parser = parse_radius,
        verbatim_doc_comment
    )]
    pub(crate) radius: Option<f64>,
    /// Number of nearest points from which each point chooses its triangles
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "N",
        default_value = "24",
        value_parser = clap::value_parser!(u16).range(6..=200)
    )]
    pub(crate) neighbours: u16,
    /// Estimate the normals even if INPUT has them
    #[arg(long)]
    pub(crate) ignore_normals: bool,
    /// Then fill the holes; the options of `holefill fill` below choose holes and method
    #[arg(long)]
    pub(crate) fill: bool,
    #[command(flatten)]
    pub(crate) how: FillHow,
    /// Number of threads, at most 1024; 0 takes one for each processor.
    /// The result does not depend on it
    #[arg(
        long,
        allow_negative_numbers = true,
        verbatim_doc_comment,
        value_name = "N",
        default_value_t = 0,
        value_parser = clap::value_parser!(u16).range(..=1024)
    )]
    pub(crate) threads: u16,
    /// Also write a report of the points and of the holes, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The options of [`FillHow`], which `points` takes only with `--fill`.
const FILL_HOW: [&str; 8] = [
    "method",
    "keep",
    "only",
    "max_edges",
    "max_perimeter",
    "keep_largest",
    "set",
    "seed",
];

#[derive(Debug, Args)]
#[command(after_help = "\
PERIMETER is in units of the file, AREA (norm of the vector area) in its square. PLANARITY is from 0 (flat)
to 0.58. EDGE is one directed boundary edge of the loop, for `fill --keep` and `fill --loop`.

Example: holefill inspect scan.ply")]
pub(crate) struct InspectArgs {
    /// Mesh to inspect
    pub(crate) input: PathBuf,
    /// Print JSON instead of a table, with the defects of the mesh and times in seconds
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Distances are in units of the files, angles in degrees.

Example: holefill compare original.ply closed.ply")]
pub(crate) struct CompareArgs {
    /// First mesh
    pub(crate) a: PathBuf,
    /// Second mesh
    pub(crate) b: PathBuf,
    /// Print JSON instead of a table
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Writes damaged.ply, filled.ply, preview.png and report.json. Replaces existing files.

Example: holefill demo")]
pub(crate) struct DemoArgs {
    /// Folder for the files; created if it does not exist
    #[arg(default_value = "holefill-demo")]
    pub(crate) dir: PathBuf,
}

/// Reads the command line.
pub(crate) fn parse() -> Result<Command, clap::Error> {
    let mut command = command();
    let matches = command.try_get_matches_from_mut(std::env::args_os())?;
    Cli::from_arg_matches(&matches)
        .map(|cli| cli.command)
        .map_err(|e| e.format(&mut command))
}

fn command() -> clap::Command {
    let fill_example =
        "Example: holefill fill scan.ply -o closed.ply --keep-largest 1 --report closed.json";
    let points_example = "Example: holefill points scan.xyz -o closed.ply --fill --keep-largest 1";
    Cli::command()
        .mut_subcommand("fill", |fill| {
            fill.after_help(methods_and_parameters(fill_example))
        })
        .mut_subcommand("points", |points| {
            FILL_HOW
                .into_iter()
                .fold(points, |points, id| {
                    points.mut_arg(id, |arg| arg.requires("fill"))
                })
                .after_help(methods_and_parameters(points_example))
        })
}

/// Prints the requested help, or an error of [`parse`].
pub(crate) fn report_error(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            // Fails only if standard output is closed.
            let _ = error.print();
        }
        _ => {
            let text = error.render().to_string();
            crate::console::message(text.trim_start_matches("error: ").trim_end());
        }
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

fn parse_edge(text: &str) -> Result<[u32; 2], String> {
    let vertices = text
        .split_once(',')
        .and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    vertices.ok_or_else(|| {
        "an edge is two vertex numbers with a comma between them, for example 17,42".to_owned()
    })
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius = text.parse().ok();
    radius
        .filter(|&radius: &f64| radius > 0.0 && radius.is_finite())
        .ok_or_else(|| "a radius is a positive number".to_owned())
}

fn parse_setting(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (key, value) =
        pair.ok_or_else(|| "a setting is KEY=VALUE, for example refine.density=2".to_owned())?;
    FillOptions::default()
        .set(&key, &value)
        .map_err(|e| e.to_string())?;
    Ok((key, value))
}

fn methods_and_parameters(example: &str) -> String {
    let mut text = String::from("Methods:\n");
    let width = Method::ALL
        .iter()
        .map(|m| m.name().len())
        .max()
        .unwrap_or(0);
    for method in Method::ALL {
        let _ = writeln!(text, "  {:width$}  {}", method.name(), method.summary());
    }
    text.push_str("\nParameters for --set:\n");
    let defaults = FillOptions::default();
    for parameter in FillOptions::parameters() {
        let (name, help) = (parameter.name(), parameter.help());
        let allowed = parameter.allowed();
        let value = parameter.value(&defaults);
        let _ = writeln!(text, "  {name}: {help}\n      {allowed} [default: {value}]");
    }
    let _ = write!(text, "\n{EXIT_STATUS}\n\n{example}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn an_edge_is_exactly_two_numbers() {
        assert_eq!(parse_edge("3,4"), Ok([3, 4]));
        for text in [
            "",
            "3",
            "3,",
            ",4",
            "3,4,5",
            "3;4",
            "-1,2",
            "3, 4",
            "4294967296,0",
        ] {
            assert!(parse_edge(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_radius_is_positive_and_finite() {
        assert_eq!(parse_radius("0.25"), Ok(0.25));
        for text in ["", "0", "-1", "nan", "inf", "1e999", "1 2", "1,5"] {
            assert!(parse_radius(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_default_number_of_neighbours_is_that_of_the_library() {
        let line = ["holefill", "points", "a.ply", "-o", "b.ply"];
        let Ok(cli) = Cli::try_parse_from(line) else {
            panic!("not understood");
        };
        let Command::Points(args) = cli.command else {
            panic!("not the command");
        };
        let expected = holefill::PointOptions::default().neighbours;
        assert_eq!(usize::from(args.neighbours), expected);
    }

    #[test]
    fn a_setting_is_checked_when_it_is_read() {
        assert!(parse_setting("refine.density=2").is_ok());
        for text in [
            "refine.density",
            "refine.density=",
            "refine.density=0",
            "=1",
            "density=1",
        ] {
            assert!(parse_setting(text).is_err(), "{text}");
        }
    }
}
