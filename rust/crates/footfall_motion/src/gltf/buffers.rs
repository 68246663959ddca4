//! Buffers of a glTF document: in the file itself, in a `data:` URI, or in files beside it.
//!
//! The `gltf` crate reads them too, but only together with decoders of pictures, and it panics at a name that is no UTF-8.

use data_url::DataUrl;
use gltf::Document;
use gltf::buffer::Source;
use percent_encoding::percent_decode_str;
use std::fmt::Display;
use std::io;
use std::path::Path;

/// Errors of reading a buffer of a glTF file.
#[derive(Debug, thiserror::Error)]
pub enum BufferError {
    /// The file that holds it cannot be read.
    #[error("{name}: {source}")]
    Missing {
        /// Its name in the document.
        name: String,
        /// Fault.
        source: io::Error,
    },
    /// Its URI cannot be read.
    #[error("cannot read the URI \"{uri}\": {fault}")]
    Uri {
        /// Its beginning: a whole buffer may be written there.
        uri: String,
        /// Fault.
        fault: String,
    },
    /// The binary chunk of a `.glb` is missing.
    #[error("the file has no binary chunk")]
    NoChunk,
    /// It has fewer bytes than the document says.
    #[error("{actual} bytes instead of {expected}")]
    Short {
        /// Bytes that the document promises.
        expected: usize,
        /// Bytes at hand.
        actual: usize,
    },
}

/// Reads all buffers of a document; names of files are relative to a folder.
///
/// # Errors
/// The first buffer that cannot be read: its index and the fault.
pub(super) fn read(
    document: &Document,
    mut chunk: Option<Vec<u8>>,
    folder: &Path,
) -> Result<Vec<Vec<u8>>, (usize, BufferError)> {
    let buffers = document.buffers().map(|buffer| {
        let bytes = match buffer.source() {
            Source::Bin => chunk.take().ok_or(BufferError::NoChunk),
            Source::Uri(uri) => follow(uri, folder),
        };
        let bytes = bytes.map_err(|error| (buffer.index(), error))?;
        if bytes.len() < buffer.length() {
            let short = BufferError::Short {
                expected: buffer.length(),
                actual: bytes.len(),
            };
            return Err((buffer.index(), short));
        }
        Ok(bytes)
    });
    buffers.collect()
}

/// The bytes that a URI leads to.
fn follow(uri: &str, folder: &Path) -> Result<Vec<u8>, BufferError> {
    let unreadable = |fault: &dyn Display| BufferError::Uri {
        uri: uri.chars().take(40).collect(),
        fault: fault.to_string(),
    };
    if uri.starts_with("data:") {
        let data = DataUrl::process(uri).map_err(|error| unreadable(&error))?;
        let decoded = data.decode_to_vec();
        let (bytes, _) = decoded.map_err(|error| unreadable(&error))?;
        return Ok(bytes);
    }
    let path = uri.strip_prefix("file:").unwrap_or(uri);
    let path = path.strip_prefix("//").unwrap_or(path);
    let name = percent_decode_str(path).decode_utf8();
    let name = name.map_err(|error| unreadable(&error))?;
    std::fs::read(folder.join(&*name)).map_err(|source| BufferError::Missing {
        name: name.into_owned(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The buffers of a document with one, of this length.
    fn one(uri: &str, length: usize, folder: &Path) -> Result<Vec<Vec<u8>>, (usize, BufferError)> {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{length},"uri":"{uri}"}}]}}"#
        );
        let file = gltf::Gltf::from_slice(json.as_bytes()).unwrap();
        read(&file.document, file.blob, folder)
    }

    #[test]
    fn bytes_are_found_in_the_document_and_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let name = "a walk é.bin";
        std::fs::write(folder.path().join(name), [1, 2, 3, 4]).unwrap();
        for uri in [
            "data:application/octet-stream;base64,AQIDBA==",
            "data:application/gltf-buffer;base64,AQIDBA==",
            "a%20walk%20%C3%A9.bin",
            name,
            &format!("file://{}/a%20walk%20é.bin", folder.path().display()),
        ] {
            let read = one(uri, 4, folder.path()).unwrap();
            assert_eq!(read, [[1, 2, 3, 4]], "{uri}");
        }
    }

    #[test]
    fn faults_name_the_buffer_and_what_is_wrong() {
        let folder = tempfile::tempdir().unwrap();
        let fault = |uri: &str, length: usize| {
            let (index, error) = one(uri, length, folder.path()).unwrap_err();
            assert_eq!(index, 0);
            error.to_string()
        };
        assert!(fault("walk.bin", 4).starts_with("walk.bin: "));
        assert_eq!(
            fault("data:;base64,AQID", 4),
            "3 bytes instead of 4",
            "a buffer that was cut off"
        );
        for uri in ["%FF.bin", "data:;base64,A", "data:no comma"] {
            let said = fault(uri, 1);
            let begins = format!("cannot read the URI \"{uri}\": ");
            assert!(
                said.starts_with(&begins) && said.len() > begins.len(),
                "{said}"
            );
        }
    }

    #[test]
    fn a_binary_file_without_its_chunk_is_refused() {
        let json = br#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]}"#;
        let file = gltf::Gltf::from_slice(json).unwrap();
        let fault = read(&file.document, None, Path::new("")).unwrap_err();
        assert!(matches!(fault, (0, BufferError::NoChunk)), "{fault:?}");
    }
}
