//! Writes files completely or not at all: to a temporary file that is renamed at the end.

use crate::error::{Error, ErrorKind, Result};
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const BUFFER_BYTES: usize = 1 << 20;

/// The destination of a file.
enum Destination {
    /// A device or pipe, which is written to in place.
    Device(PathBuf),
    /// A file that is made or replaced.
    File {
        target: PathBuf,
        folder: PathBuf,
        /// The permissions of the existing file, if there is one.
        permissions: Option<Permissions>,
    },
}

impl Destination {
    fn of(path: &Path) -> Result<Self> {
        let target = resolved(path);
        let permissions = match fs::metadata(&target) {
            Ok(found) if found.is_dir() => return Err(failed(path, "it is a folder")),
            Ok(found) if !found.is_file() => return Ok(Self::Device(target)),
            Ok(found) if found.permissions().readonly() => {
                return Err(failed(path, "the existing file is read-only"));
            }
            Ok(found) => Some(found.permissions()),
            Err(_) => None,
        };
        let folder = folder_of(&target);
        if !folder.is_dir() {
            let reason = format!("there is no folder {}", folder.display());
            return Err(failed(path, &reason));
        }
        Ok(Self::File {
            target,
            folder,
            permissions,
        })
    }
}

/// Checks that [`replace`] can write to `path`, as far as this can be known in advance: it is no folder and not
/// read-only, and new files can be made in its folder.
///
/// # Errors
/// [`ErrorKind::Io`] as [`replace`].
pub fn check_destination(path: &Path) -> Result<()> {
    if let Destination::File { folder, .. } = Destination::of(path)? {
        tempfile::tempfile_in(&folder).map_err(|error| failed(path, &error.to_string()))?;
    }
    Ok(())
}

/// Whether two paths name the same file, as far as this can be known before it exists.
#[must_use]
pub fn is_same_destination(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        let path = resolved(path);
        let folder = folder_of(&path);
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        path.file_name().map(|name| folder.join(name))
    };
    place(a) == place(b)
}

/// Creates or replaces the file at `path`; `write` writes its contents.
///
/// The bytes go to a temporary file in the same folder, which is renamed when they are on the disk. On an error it is
/// removed, and the file at `path` stays unchanged. A symbolic link is followed. A new file gets the permissions of the
/// file that it replaces. A device or pipe is written to in place.
///
/// # Errors
/// [`ErrorKind::Io`] with the path or, when it is missing, the folder.
pub fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<()> {
    let io_error = |error: io::Error| failed(path, &error.to_string());
    let (target, folder, permissions) = match Destination::of(path)? {
        Destination::Device(target) => {
            let device = File::options().write(true).open(&target);
            return write_buffered(&device.map_err(io_error)?, write).map_err(io_error);
        }
        Destination::File {
            target,
            folder,
            permissions,
        } => (target, folder, permissions),
    };
    let temporary = new_temporary(&folder).map_err(io_error)?;
    if let Some(permissions) = permissions {
        temporary
            .as_file()
            .set_permissions(permissions)
            .map_err(io_error)?;
    }
    write_buffered(temporary.as_file(), write).map_err(io_error)?;
    temporary.as_file().sync_all().map_err(io_error)?;
    temporary
        .persist(&target)
        .map_err(|error| io_error(error.error))?;
    Ok(())
}

fn failed(path: &Path, reason: &str) -> Error {
    Error::new(
        ErrorKind::Io,
        format!("cannot write {}: {reason}", path.display()),
    )
}

/// The target of `path` if it is a link. The target need not exist.
fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path)
        .or_else(|_| fs::read_link(path).map(|target| folder_of(path).join(target)))
        .unwrap_or_else(|_| path.to_owned())
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".holefill-").suffix(".tmp");
    // Temporary files are private to the user. This one gets the usual permissions of a new file; the umask applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn write_buffered(
    file: &File,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, file);
    write(&mut buffered)?;
    buffered.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let fail = |out: &mut BufWriter<&File>| {
            out.write_all(&[b'x'; 3 * BUFFER_BYTES])?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };
        let error = replace(&path, fail).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert!(error.message().contains("out"), "{error}");
        assert!(names_in(folder.path()).is_empty());

        fs::write(&path, "old").unwrap();
        replace(&path, fail).unwrap_err();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["out"]);

        replace(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names_in(folder.path()), ["out"]);
    }

    #[test]
    fn a_missing_folder_is_named_and_a_folder_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let error = replace(&missing.join("out"), |_| Ok(())).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert!(
            error.message().ends_with(&missing.display().to_string()),
            "{error}"
        );
        let error = replace(folder.path(), |_| Ok(())).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert!(names_in(folder.path()).is_empty());
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        fs::write(&path, "old").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = replace(&path, |out| out.write_all(b"new")).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["out"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_a_new_file_or_of_the_replaced_one() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        File::create(&plain).unwrap();
        replace(&ours, |_| Ok(())).unwrap();
        assert_eq!(mode(&ours), mode(&plain));
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        replace(&ours, |_| Ok(())).unwrap();
        assert_eq!(mode(&ours), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_stays_and_its_target_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        replace(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_to_a_file_still_to_come_is_followed() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("target", &link).unwrap();
        check_destination(&link).unwrap();
        replace(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(folder.path().join("target")).unwrap(), b"new");
    }

    #[test]
    fn a_missing_folder_and_a_folder_in_the_way_are_refused_beforehand() {
        let folder = tempfile::tempdir().unwrap();
        assert!(check_destination(&folder.path().join("no/a")).is_err());
        assert!(check_destination(folder.path()).is_err());
        assert!(check_destination(&folder.path().join("a")).is_ok());
        assert!(names_in(folder.path()).is_empty());
    }

    #[test]
    fn the_same_place_is_recognised_through_detours() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        let detour = folder.path().join("sub/../a");
        assert!(is_same_destination(&detour, &folder.path().join("a")));
        assert!(!is_same_destination(&detour, &folder.path().join("b")));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_io_error() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("full");
        std::os::unix::fs::symlink("/dev/full", &link).unwrap();
        let error = replace(&link, |out| out.write_all(&[0; 100])).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert_eq!(names_in(folder.path()), ["full"]);
    }
}
