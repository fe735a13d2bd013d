//! Checks of the files to be written, made before the work starts.

use crate::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Checks that a file can be made at `path`: it is no folder, and its folder takes new files.
pub(crate) fn check(path: &Path) -> Result<(), Failure> {
    let fail = |why: &dyn std::fmt::Display| {
        Err(Failure::file(format!(
            "cannot write {}: {why}",
            path.display()
        )))
    };
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return fail(&"it is a folder"),
        // A device or pipe is written to in place.
        Ok(found) if !found.is_file() => return Ok(()),
        Ok(found) if found.permissions().readonly() => return fail(&"it is read-only"),
        _ => {}
    }
    let folder = folder_of(&resolved(path));
    if !folder.is_dir() {
        return fail(&format!("there is no folder {}", folder.display()));
    }
    match tempfile::tempfile_in(&folder) {
        Ok(_) => Ok(()),
        Err(error) => fail(&error),
    }
}

/// Whether two paths name the same file, as far as can be told before it exists.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        let path = resolved(path);
        let folder = folder_of(&path);
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        path.file_name().map(|name| folder.join(name))
    };
    place(a) == place(b)
}

/// The file that `path` stands for when it is a link.
fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_folder_and_a_folder_in_the_way_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        assert!(check(&dir.path().join("no/a")).is_err());
        assert!(check(dir.path()).is_err());
        assert!(check(&dir.path().join("a")).is_ok());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }

    #[test]
    fn the_same_place_is_recognised_through_detours() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("sub")).unwrap();
        let detour = dir.path().join("sub/../a");
        assert!(is_same(&detour, &dir.path().join("a")));
        assert!(!is_same(&detour, &dir.path().join("b")));
    }
}
