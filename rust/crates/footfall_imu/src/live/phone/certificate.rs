//! The server's certificate: signed by itself, made at the first start, kept.

use std::fs;
use std::io::{self, Write as _};
use std::net::IpAddr;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Age at which it is made again; browsers accept certificates for up to 825 days.
const KEPT: Duration = Duration::from_hours(300 * 24);
const VALID_DAYS: u32 = 397;

/// Certificate and private key, both as PEM.
#[derive(Debug)]
pub(super) struct Certificate {
    pub(super) certificate: String,
    pub(super) key: String,
}

/// Reads what is kept in the folder, or makes it.
pub(super) fn load_or_make(folder: &Path, own: IpAddr) -> Result<Certificate, String> {
    let (certificate_path, key_path) = (folder.join("certificate.pem"), folder.join("key.pem"));
    let young = |path: &Path| {
        let age = fs::metadata(path).and_then(|data| data.modified());
        age.is_ok_and(|made| {
            SystemTime::now()
                .duration_since(made)
                .is_ok_and(|age| age < KEPT)
        })
    };
    if young(&certificate_path)
        && young(&key_path)
        && let (Ok(certificate), Ok(key)) = (
            fs::read_to_string(&certificate_path),
            fs::read_to_string(&key_path),
        )
    {
        return Ok(Certificate { certificate, key });
    }
    let made = make(own).map_err(|error| format!("cannot create a certificate: {error}"))?;
    let keep = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        write_private(&key_path, &made.key)?;
        write_private(&certificate_path, &made.certificate)
    };
    keep().map_err(|error| {
        format!(
            "{}: cannot save the certificate ({error}); check the folder's write permission",
            folder.display()
        )
    })?;
    Ok(made)
}

fn make(own: IpAddr) -> Result<Certificate, rcgen::Error> {
    let mut params = rcgen::CertificateParams::new(vec!["localhost".to_owned(), own.to_string()])?;
    params
        .distinguished_name
        .push(rcgen::DnType::CommonName, "Footfall on this network");
    let now = SystemTime::now();
    let day = Duration::from_hours(24);
    params.not_before = (now - day).into();
    params.not_after = (now + day * VALID_DAYS).into();
    params
        .extended_key_usages
        .push(rcgen::ExtendedKeyUsagePurpose::ServerAuth);
    let key = rcgen::KeyPair::generate()?;
    let certificate = params.self_signed(&key)?;
    Ok(Certificate {
        certificate: certificate.pem(),
        key: key.serialize_pem(),
    })
}

/// Writes a file that its owner alone may read, whole or not at all.
fn write_private(path: &Path, text: &str) -> io::Result<()> {
    let temporary = path.with_extension(format!("{}.part", std::process::id()));
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut file = options.open(&temporary)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    drop(file);
    fs::rename(&temporary, path)
}
