//! Frameworks of macOS for the linker, as text that names what the library's crates name in them: zig brings the system's library alone.
//!
//! A linker takes from such a file which framework has a name, and nothing else; the code is on the player's machine.

use crate::fetch;
use anyhow::{Context as _, Result};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Both architectures of macOS.
pub(super) const TARGETS: [&str; 2] = ["aarch64-apple-darwin", "x86_64-apple-darwin"];

/// A framework, where it is on a Mac, and what of it the library's crates name: `serialport` asks for the ports. Most of it is never called, but the linker wants all before it strips that.
struct Framework {
    name: &'static str,
    symbols: &'static [&'static str],
}

const FRAMEWORKS: [Framework; 2] = [
    Framework {
        name: "IOKit",
        symbols: &[
            "IOIteratorNext",
            "IOMasterPort",
            "IOObjectGetClass",
            "IOObjectRelease",
            "IORegistryEntryCreateCFProperties",
            "IORegistryEntryCreateCFProperty",
            "IORegistryEntryGetParentEntry",
            "IOServiceGetMatchingServices",
            "IOServiceMatching",
            "kIOMasterPortDefault",
        ],
    },
    Framework {
        name: "CoreFoundation",
        symbols: &[
            "CFAttributedStringCreateMutable",
            "CFBundleCopyBundleURL",
            "CFBundleCopyExecutableURL",
            "CFBundleCopyPrivateFrameworksURL",
            "CFBundleCopyResourcesDirectoryURL",
            "CFBundleCopySharedSupportURL",
            "CFBundleCreate",
            "CFBundleGetBundleWithIdentifier",
            "CFBundleGetFunctionPointerForName",
            "CFBundleGetInfoDictionary",
            "CFBundleGetMainBundle",
            "CFCopyDescription",
            "CFDataCreate",
            "CFDateGetAbsoluteTime",
            "CFDictionaryAddValue",
            "CFDictionaryGetValueIfPresent",
            "CFDictionarySetValue",
            "CFEqual",
            "CFErrorCopyDescription",
            "CFErrorGetCode",
            "CFErrorGetDomain",
            "CFFileDescriptorCreate",
            "CFFileDescriptorCreateRunLoopSource",
            "CFFileDescriptorDisableCallBacks",
            "CFFileDescriptorEnableCallBacks",
            "CFFileDescriptorGetContext",
            "CFFileDescriptorGetNativeDescriptor",
            "CFFileDescriptorInvalidate",
            "CFFileDescriptorIsValid",
            "CFGetTypeID",
            "CFMachPortCreateRunLoopSource",
            "CFNumberGetTypeID",
            "CFNumberGetValue",
            "CFPropertyListCreateData",
            "CFPropertyListCreateWithData",
            "CFRelease",
            "CFRetain",
            "CFRunLoopAddObserver",
            "CFRunLoopAddSource",
            "CFRunLoopAddTimer",
            "CFRunLoopContainsObserver",
            "CFRunLoopContainsSource",
            "CFRunLoopContainsTimer",
            "CFRunLoopCopyCurrentMode",
            "CFRunLoopGetCurrent",
            "CFRunLoopGetMain",
            "CFRunLoopRemoveObserver",
            "CFRunLoopRemoveSource",
            "CFRunLoopRemoveTimer",
            "CFRunLoopRun",
            "CFRunLoopRunInMode",
            "CFRunLoopStop",
            "CFRunLoopTimerCreate",
            "CFShow",
            "CFStringCreateWithBytes",
            "CFStringCreateWithBytesNoCopy",
            "CFStringGetBytes",
            "CFStringGetCString",
            "CFStringGetCStringPtr",
            "CFStringGetLength",
            "CFStringGetTypeID",
            "CFTimeZoneCopyDefault",
            "CFTimeZoneGetName",
            "CFTimeZoneGetSecondsFromGMT",
            "CFURLCopyAbsoluteURL",
            "CFURLCopyFileSystemPath",
            "CFURLCreateWithFileSystemPath",
            "CFURLGetFileSystemRepresentation",
            "CFURLGetString",
            "CFUUIDCreate",
            "kCFAllocatorDefault",
            "kCFAllocatorNull",
            "kCFBooleanFalse",
            "kCFBooleanTrue",
        ],
    },
];

/// Every name of the frameworks that the linker knows of, as macOS writes it.
pub(crate) fn names() -> impl Iterator<Item = String> {
    let symbols = FRAMEWORKS.iter().flat_map(|framework| framework.symbols);
    symbols.map(|symbol| format!("_{symbol}"))
}

/// Has a build find the frameworks.
///
/// # Errors
/// When they cannot be written into the cache.
pub(super) fn link_frameworks(cargo: &mut Command) -> Result<()> {
    let folder = fetch::once("macos", &version(), |folder| {
        FRAMEWORKS
            .iter()
            .try_for_each(|framework| write(framework, folder))
    })?;
    for target in TARGETS {
        let flags = serde_json::json!([format!("-Lframework={}", folder.display())]);
        cargo.arg("--config");
        cargo.arg(format!("target.{target}.rustflags={flags}"));
    }
    Ok(())
}

/// Text that changes with the list of names.
fn version() -> String {
    FRAMEWORKS
        .iter()
        .flat_map(|framework| framework.symbols)
        .fold(String::from("1"), |all, symbol| all + " " + symbol)
}

fn write(framework: &Framework, folder: &Path) -> Result<()> {
    let name = framework.name;
    let folder = folder.join(format!("{name}.framework"));
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let file = folder.join(format!("{name}.tbd"));
    fs::write(&file, text(framework)).with_context(|| format!("cannot write {}", file.display()))
}

/// A stub library in Apple's text format, version 4.
fn text(framework: &Framework) -> String {
    let name = framework.name;
    let targets = "[ x86_64-macos, arm64-macos ]";
    let symbols: Vec<String> = framework
        .symbols
        .iter()
        .map(|symbol| format!("_{symbol}"))
        .collect();
    let symbols = symbols.join(", ");
    format!(
        "--- !tapi-tbd\ntbd-version: 4\ntargets: {targets}\n\
         install-name: '/System/Library/Frameworks/{name}.framework/Versions/A/{name}'\n\
         exports:\n  - targets: {targets}\n    symbols: [ {symbols} ]\n...\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stub_names_its_place_and_its_symbols() {
        let text = text(&FRAMEWORKS[0]);
        assert!(text.contains("'/System/Library/Frameworks/IOKit.framework/Versions/A/IOKit'"));
        assert!(text.contains("[ _IOIteratorNext, _IOMasterPort,"), "{text}");
        assert!(text.ends_with(" ]\n...\n"));
    }
}
