//! The page for phones in a real browser, with emulated sensors, against the real server. Skipped where Chromium is not installed.

use crate::signal::{wait_for, wait_for_address, wait_for_samples};
use footfall_imu::ImuSample;
use footfall_imu::live::phone::{PhoneConfig, PhoneServer};
use footfall_tests::browser::chromium;
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

/// A browser that is controlled over its debugging protocol.
struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    session: String,
    next: u64,
    _profile: tempfile::TempDir,
}

impl Browser {
    fn start() -> Option<Self> {
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new(chromium("browser")?)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-quic",
                "--disable-dev-shm-usage",
            ])
            .args([
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
            ])
            // The person accepts the certificate that the game signed itself.
            .args([
                "--ignore-certificate-errors",
                "--remote-debugging-port=0",
                "--window-size=420,760",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("Chromium starts");
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let url = lines
            .map_while(Result::ok)
            .find_map(|line| {
                line.strip_prefix("DevTools listening on ")
                    .map(str::to_owned)
            })
            .expect("its debugging port");
        let address = url
            .trim_start_matches("ws://")
            .split('/')
            .next()
            .unwrap()
            .to_owned();
        let stream = TcpStream::connect(address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        let (socket, _) = tungstenite::client::client(url, stream).unwrap();
        let mut browser = Self {
            child,
            socket,
            session: String::new(),
            next: 0,
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let attached = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", &attached);
        session["sessionId"]
            .as_str()
            .unwrap()
            .clone_into(&mut browser.session);
        browser.call("Page.enable", &json!({}));
        Some(browser)
    }

    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.next += 1;
        let mut call = json!({ "id": self.next, "method": method, "params": parameters });
        if !self.session.is_empty() {
            call["sessionId"] = json!(self.session);
        }
        self.socket
            .send(Message::Text(call.to_string().into()))
            .unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else {
                continue;
            };
            let reply: Value = serde_json::from_str(&text).unwrap();
            if reply["id"] == json!(self.next) {
                assert!(reply["error"].is_null(), "{method}: {}", reply["error"]);
                return reply["result"].clone();
            }
        }
    }

    fn run(&mut self, script: &str) -> Value {
        let parameters = json!({ "expression": script, "userGesture": true, "awaitPromise": true, "returnByValue": true });
        let result = self.call("Runtime.evaluate", &parameters);
        assert!(result["exceptionDetails"].is_null(), "{script}: {result}");
        result["result"]["value"].clone()
    }

    fn visit(&mut self, url: &str) {
        self.call("Page.navigate", &json!({ "url": url }));
        wait_for("the page", || {
            (self.run("document.readyState") == "complete").then_some(())
        });
        assert_eq!(self.run("document.title"), "Footfall: this phone walks");
    }

    fn state(&mut self) -> String {
        self.run("document.getElementById('state').textContent")
            .as_str()
            .unwrap()
            .to_owned()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn game() -> (PhoneServer, String, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let server = PhoneServer::start(PhoneConfig {
        port: 0,
        players: 1,
        folder: folder.path().to_owned(),
    })
    .unwrap();
    let address = wait_for_address(server.link());
    let url = server.url(0).unwrap();
    let path = &url[url.find("/p/").unwrap()..];
    (server, format!("https://{address}{path}"), folder)
}

#[test]
fn a_phone_with_newer_sensors_streams() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let (server, url, _folder) = game();
    for kind in ["accelerometer", "gyroscope"] {
        let metadata = json!({ "minimumFrequency": 1, "maximumFrequency": 100 });
        browser.call(
            "Emulation.setSensorOverrideEnabled",
            &json!({ "enabled": true, "type": kind, "metadata": metadata }),
        );
    }
    let set = |browser: &mut Browser, n: u32| {
        let wave = (f64::from(n) * 0.3).sin();
        for (kind, [x, y, z]) in [
            ("accelerometer", [1.0, 9.5, wave]),
            ("gyroscope", [0.5, 0.1 * wave, wave]),
        ] {
            let reading = json!({ "xyz": { "x": x, "y": y, "z": z } });
            browser.call(
                "Emulation.setSensorOverrideReadings",
                &json!({ "type": kind, "reading": reading }),
            );
        }
    };
    set(&mut browser, 0);
    browser.visit(&url);
    browser.run("document.getElementById('begin').click()");
    let device = server.link().device(0).unwrap();
    let mut found: Vec<ImuSample> = Vec::new();
    for n in 0..600 {
        set(&mut browser, n);
        std::thread::sleep(Duration::from_millis(10));
        device.take(|sample| found.push(sample));
        if found.len() > 150 {
            break;
        }
    }
    assert!(
        found.len() > 150,
        "{} samples: {}",
        found.len(),
        browser.state()
    );
    // The browser gives steps of a tenth.
    for sample in &found[5..] {
        assert!(
            (sample.force.x - 1.0).abs() < 0.11 && (sample.force.y - 9.5).abs() < 0.11,
            "{sample:?}"
        );
        assert!((sample.rate.x - 0.5).abs() < 0.11, "{sample:?}");
    }
    wait_for("the page says that it works", || {
        browser
            .state()
            .contains("receives this phone's motion")
            .then_some(())
    });
    let figures = browser.run("document.getElementById('figures').textContent");
    assert!(
        figures.as_str().unwrap().contains("samples a second"),
        "{figures}"
    );
}

/// A phone whose browser has events alone: `order` names what alpha, beta and gamma turn about, and iOS gives forces with the other sign. It is
/// turned about its own x at 1 rad/s, then about its y.
const EVENTS: &str = r#"
(async () => {
  const order = ORDER, sign = SIGN, degrees = 180 / Math.PI;
  document.getElementById("begin").click();
  let turn = [0, 0], now = 0;
  for (let n = 0; n < 400; n++) {
    const about = Math.floor(n / 60) % 2, rate = [0, 0, 0], secs = 0.016;
    rate[about] = Math.floor(n / 120) % 2 ? -1 : 1;
    turn[about] += rate[about] * secs;
    // Turned about x by b, then about its own y by g.
    const [b, g] = turn;
    const up = [-Math.cos(b) * Math.sin(g), Math.sin(b), Math.cos(b) * Math.cos(g)];
    // About x means about the phone's own x only while it is not turned about y: turn it back before.
    const given = { spec: [rate[2], rate[0], rate[1]], old: rate }[order].map((r) => r * degrees);
    dispatchEvent(new DeviceOrientationEvent("deviceorientation", { alpha: 0, beta: b * degrees, gamma: g * degrees }));
    dispatchEvent(new DeviceMotionEvent("devicemotion", {
      accelerationIncludingGravity: { x: sign * 9.8 * up[0], y: sign * 9.8 * up[1], z: sign * 9.8 * up[2] },
      rotationRate: { alpha: given[0], beta: given[1], gamma: given[2] }, interval: 16,
    }));
    await new Promise((done) => setTimeout(done, 8));
  }
})()
"#;

#[test]
fn axes_and_signs_of_every_browser_are_found_out() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let hide = "delete window.Accelerometer; delete window.Gyroscope;";
    browser.call(
        "Page.addScriptToEvaluateOnNewDocument",
        &json!({ "source": hide }),
    );
    for (order, sign) in [("spec", 1), ("old", 1), ("old", -1), ("spec", -1)] {
        let (server, url, _folder) = game();
        browser.visit(&url);
        let script = EVENTS
            .replace("ORDER", &format!("\"{order}\""))
            .replace("SIGN", &sign.to_string());
        browser.run(&script);
        let device = server.link().device(0).unwrap();
        let found = wait_for_samples(&device, 300);
        // Once it is found out, the rates are about x and y, never about z, and up is where the force points.
        let (mut about_z, mut checked) = (0.0_f32, 0);
        for pair in found[200..].windows(2) {
            about_z = about_z.max(pair[0].rate.z.abs());
            assert!(pair[0].force.z > 0.0, "{order} {sign}: {:?}", pair[0]);
            checked += 1;
        }
        assert!(
            checked > 90 && about_z < 1e-3,
            "{order} {sign}: {about_z} rad/s about z"
        );
        let last = found.last().unwrap();
        assert!((last.rate.length() - 1.0).abs() < 1e-2, "{last:?}");
    }
}
