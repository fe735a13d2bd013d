//! Files that appear whole or not at all, and checks made before the work starts.

use crate::Failure;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
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
        Ok(found) if !found.is_file() => return Ok(()),
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

/// Writes a file through a neighbour that takes its place when it is complete. What is no regular
/// file, such as a pipe, is written to directly.
pub(crate) fn write(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    write_whole(path, content)
        .map_err(|error| Failure::file(format!("cannot write {}: {error}", path.display())))
}

fn write_whole(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let path = resolved(path);
    let existing = fs::metadata(&path).ok();
    if existing.as_ref().is_some_and(|found| !found.is_file()) {
        let mut file = BufWriter::new(File::options().write(true).open(&path)?);
        content(&mut file)?;
        return file.flush();
    }
    let mut builder = tempfile::Builder::new();
    if let Some(permissions) = existing
        .map(|found| found.permissions())
        .or_else(usual_permissions)
    {
        builder.permissions(permissions);
    }
    let mut file = BufWriter::new(builder.tempfile_in(folder_of(&path))?);
    content(&mut file)?;
    let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.persist(&path).map(drop).map_err(|e| e.error)
}

/// What a new file is made with, before the user's mask: temporary files are private otherwise.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
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
    fn content_that_fails_leaves_the_old_file_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        fs::write(&path, "old").unwrap();
        let result = write(&path, |out| {
            out.write_all(b"new")?;
            Err(io::Error::other("stop"))
        });
        assert!(result.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

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

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_are_respected() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let (target, link) = (dir.path().join("target"), dir.path().join("link"));
        fs::write(&target, "old").unwrap();
        fs::set_permissions(&target, Permissions::from_mode(0o640)).unwrap();
        symlink(&target, &link).unwrap();
        write(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
        assert_eq!(
            fs::metadata(&target).unwrap().permissions().mode() & 0o777,
            0o640
        );
        write(Path::new("/dev/null"), |out| out.write_all(b"x")).unwrap();
        assert!(
            fs::metadata("/dev/null")
                .unwrap()
                .file_type()
                .is_char_device()
        );
    }
}
