//! Meshes to fill: one folder each, with `input.ply` and `meta.json`.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::Result;

/// A folder with an input, and the loops to leave open in it.
pub(crate) struct Job {
    pub(crate) name: String,
    pub(crate) folder: PathBuf,
    keep: Vec<String>,
    /// Edges of the rims to fill.
    pub(crate) edges: u64,
}

impl Job {
    fn read(folder: PathBuf) -> Result<Self> {
        let meta = read_json(&folder.join("meta.json"))?;
        let name = folder
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        let list = |key: &str| meta[key].as_array().cloned().unwrap_or_default();
        let keep = list("keep_loops")
            .iter()
            .map(|l| match (l["edge"][0].as_u64(), l["edge"][1].as_u64()) {
                (Some(v0), Some(v1)) => Ok(format!("{v0},{v1}")),
                _ => Err(format!("{}: a loop to keep has no edge", folder.display()).into()),
            })
            .collect::<Result<_>>()?;
        let edges = list("fill_loops")
            .iter()
            .filter_map(|l| l["n_edges"].as_u64())
            .sum();
        Ok(Self {
            name: name.unwrap_or_default(),
            folder,
            keep,
            edges,
        })
    }

    #[cfg(test)]
    pub(crate) fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            folder: PathBuf::new(),
            keep: Vec::new(),
            edges: 0,
        }
    }

    /// The file to fill.
    pub(crate) fn input(&self) -> String {
        self.folder.join("input.ply").display().to_string()
    }

    /// `--keep V0,V1` for every loop that stays open.
    pub(crate) fn keep_args(&self) -> impl Iterator<Item = String> + '_ {
        self.keep
            .iter()
            .flat_map(|edge| ["--keep".to_owned(), edge.clone()])
    }
}

/// Reads a JSON file.
pub(crate) fn read_json(path: &Path) -> Result<Value> {
    let text =
        fs::read_to_string(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()).into())
}

/// The folders in `dir` whose name contains `only`, by name.
pub(crate) fn jobs(dir: Option<&Path>, only: Option<&str>) -> Result<Vec<Job>> {
    let Some(dir) = dir else {
        return Ok(Vec::new());
    };
    let entries = fs::read_dir(dir).map_err(|e| format!("cannot read {}: {e}", dir.display()))?;
    let mut folders = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    folders.retain(|folder| {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        folder.join("meta.json").exists() && only.is_none_or(|text| name.contains(text))
    });
    folders.sort();
    folders.into_iter().map(Job::read).collect()
}
