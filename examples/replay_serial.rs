//! Replays a transcript of the serial link against the core, or measures its speed.
//!
//! ```text
//! cargo run --example replay_serial -- tests/fixtures/serial/handshake.txt
//! cargo run --release --example replay_serial -- --throughput 2000000
//! ```
//!
//! A transcript is lines:
//!
//! | line | meaning |
//! |---|---|
//! | `# text` | comment |
//! | `job G1 X1` | the job has this line; `job*300 G1 X{i}` stands for 300, `{i}` counts from 0 |
//! | `! command` | `connect`, `start [first line]`, `pause`, `resume`, `cancel`, `stop`, `close`, `send G28`, `speed 120`, `flow 95` |
//! | `! ready`, `! print` | a whole handshake; handshake and start of the job, up to its first line |
//! | `! refused command` | the command must be refused |
//! | `< text` | the printer says this line |
//! | `> text` | the host has sent this line next; number yes, checksum no (it is verified) |
//! | `+ 0.5` | seconds pass |
//! | `repeat 250` | that many lines are sent, and each is answered `ok` |
//! | `= printing` | the state |
//! | `? text` | an event since the last `?` holds this text |
//! | `option polling` | temperatures are asked for; else only once after the handshake |
//!
//! Whatever is sent must stand there: a line too many is an error as one too few.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use foothold::printer::{CommandError, Event, JobStart, Printer, PrinterOptions, State};

/// What a replay has said and heard, and what is still unread of it.
struct Replay {
    printer: Printer,
    now: Duration,
    job: Vec<String>,
    sent: VecDeque<String>,
    events: Vec<String>,
}

/// Replays the text; the lines sent, or the line of the transcript that does not hold.
pub fn replay(text: &str) -> Result<Vec<String>, String> {
    let mut options = PrinterOptions::default();
    if !text.lines().any(|line| line.trim() == "option polling") {
        options.temperature_interval = Duration::from_secs(3600);
        options.count_check_interval = Duration::from_secs(3600);
    }
    let printer = Printer::new(options).map_err(|error| error.to_string())?;
    let mut replay =
        Replay { printer, now: Duration::ZERO, job: Vec::new(), sent: VecDeque::new(), events: Vec::new() };
    let mut log = Vec::new();
    for (number, line) in text.lines().enumerate() {
        replay.line(line.trim(), &mut log).map_err(|why| format!("line {}: `{line}`: {why}", number + 1))?;
    }
    replay.all_read().map_err(|why| format!("at the end: {why}"))?;
    Ok(log)
}

impl Replay {
    fn line(&mut self, line: &str, log: &mut Vec<String>) -> Result<(), String> {
        let (head, rest) = line.split_once(' ').unwrap_or((line, ""));
        match head {
            "" | "#" | "option" => {}
            ">" => {
                let sent = self.sent.pop_front().ok_or("nothing was sent")?;
                if sent != rest {
                    return Err(format!("sent was `{sent}`"));
                }
                log.push(sent);
            }
            "=" if self.printer.state().to_string() != rest => {
                return Err(format!("is {}", self.printer.state()));
            }
            "=" => {}
            "?" => self.expect_event(rest)?,
            "job" => self.job.push(rest.to_owned()),
            _ if head.starts_with("job*") => {
                let count: usize = head["job*".len()..].parse().map_err(|_| "no number")?;
                self.job.extend((0..count).map(|i| rest.replace("{i}", &i.to_string())));
            }
            _ => {
                if head != "repeat" {
                    self.all_read()?;
                }
                self.act(head, rest)?;
            }
        }
        Ok(())
    }

    fn act(&mut self, head: &str, rest: &str) -> Result<(), String> {
        match head {
            "<" => self.hear(rest)?,
            "!" => match rest {
                "ready" => self.ready()?,
                "print" => self.print()?,
                _ => self.command_or_refusal(rest)?,
            },
            "+" => self.pass(rest.parse().map_err(|_| "no time")?)?,
            "repeat" => {
                for turn in 0..rest.parse().map_err(|_| "no number")? {
                    self.sent.pop_front().ok_or(format!("nothing was sent in turn {turn}"))?;
                    self.hear("ok")?;
                }
            }
            _ => return Err("no such line".to_owned()),
        }
        Ok(())
    }

    fn command_or_refusal(&mut self, text: &str) -> Result<(), String> {
        let done = match text.strip_prefix("refused ") {
            Some(text) => match self.command(text)? {
                Ok(()) => return Err("was not refused".to_owned()),
                Err(_) => Ok(()),
            },
            None => self.command(text)?,
        };
        done.map_err(|error| error.to_string())?;
        self.collect()
    }

    fn command(&mut self, text: &str) -> Result<Result<(), CommandError>, String> {
        let (name, value) = text.split_once(' ').unwrap_or((text, "0"));
        let now = self.now;
        Ok(match name {
            "connect" => self.printer.connect(now),
            "start" => {
                let lines = self.job.clone().into_iter().map(String::into_bytes);
                let first_line = value.parse().map_err(|_| "no number")?;
                let restore = first_line > 0;
                let start = JobStart { first_line, restore, ..JobStart::new(Box::new(lines)) };
                self.printer.start(now, start)
            }
            "pause" => self.printer.pause(now),
            "resume" => self.printer.resume(now),
            "cancel" => self.printer.cancel(now),
            "stop" => self.printer.emergency_stop(now),
            "close" => {
                self.printer.handle_closed(now);
                Ok(())
            }
            "send" => self.printer.send_line(now, value),
            "speed" => self.printer.set_speed(now, value.parse().map_err(|_| "no number")?),
            "flow" => self.printer.set_flow(now, value.parse().map_err(|_| "no number")?),
            _ => return Err("no such command".to_owned()),
        })
    }

    fn ready(&mut self) -> Result<(), String> {
        let introduction = "FIRMWARE_NAME:Marlin 2.1.2 MACHINE_TYPE:Replay";
        self.script("connect", &[&["ok"], &[introduction, "ok"], &["ok T:20.0 /0.0 B:20.0 /0.0"]])?;
        self.events.clear();
        Ok(())
    }

    fn print(&mut self) -> Result<(), String> {
        self.ready()?;
        self.pass(1.0)?;
        self.script("start", &[&["ok"], &["ok T:20.0 /0.0 B:20.0 /0.0"]])?;
        self.events.clear();
        Ok(())
    }

    /// A command, and answers to the lines that follow from it.
    fn script(&mut self, command: &str, answers: &[&[&str]]) -> Result<(), String> {
        self.command(command)?.map_err(|error| error.to_string())?;
        self.collect()?;
        for answer in answers {
            self.sent.pop_front().ok_or("nothing was sent")?;
            answer.iter().try_for_each(|line| self.hear(line))?;
        }
        Ok(())
    }

    fn hear(&mut self, line: &str) -> Result<(), String> {
        self.printer.handle_bytes(self.now, format!("{line}\n").as_bytes());
        self.collect()
    }

    fn pass(&mut self, seconds: f64) -> Result<(), String> {
        let end = self.now + Duration::from_secs_f64(seconds);
        while let Some(at) = self.printer.poll_timeout().filter(|at| *at <= end) {
            self.now = self.now.max(at);
            self.printer.handle_timeout(self.now);
            self.collect()?;
        }
        self.now = end;
        Ok(())
    }

    fn collect(&mut self) -> Result<(), String> {
        while let Some(bytes) = self.printer.poll_transmit() {
            let text = String::from_utf8(bytes).map_err(|_| "sent bytes that are no text")?;
            for line in text.lines().filter(|line| !line.is_empty()) {
                self.sent.push_back(without_checksum(line)?);
            }
        }
        while let Some(event) = self.printer.poll_event() {
            self.events.push(describe(&event));
        }
        Ok(())
    }

    fn expect_event(&mut self, text: &str) -> Result<(), String> {
        let at = self.events.iter().position(|event| event.contains(text));
        let at = at.ok_or_else(|| format!("events are {:?}", self.events))?;
        self.events.drain(..=at);
        Ok(())
    }

    fn all_read(&self) -> Result<(), String> {
        self.sent.front().map_or(Ok(()), |line| Err(format!("`{line}` was sent too")))
    }
}

/// The line without its checksum, which must be right; a line without number has none.
fn without_checksum(line: &str) -> Result<String, String> {
    if !line.starts_with('N') {
        return Ok(line.to_owned());
    }
    let (text, sum) = line.rsplit_once('*').ok_or_else(|| format!("`{line}` has no checksum"))?;
    let right = text.bytes().fold(0, |sum, byte| sum ^ byte);
    if sum == right.to_string() { Ok(text.to_owned()) } else { Err(format!("`{line}` has a wrong checksum")) }
}

fn describe(event: &Event) -> String {
    match event {
        Event::Stopped { reason, journal } => {
            let line = journal.and_then(|journal| journal.acked_line);
            format!("stopped after {line:?}: {reason}")
        }
        Event::Paused(reason) => format!("paused: {reason}"),
        Event::Finished(journal) => format!("finished after {:?}", journal.acked_line),
        Event::State { to, .. } => format!("state: {to}"),
        Event::Message(text) => format!("message: {text}"),
        Event::Warning(text) => format!("warning: {text}"),
        other => format!("{other:?}"),
    }
}

/// Acknowledged lines a second against a printer that answers at once.
fn throughput(lines: u64) -> Result<f64, String> {
    let mut printer = Printer::new(PrinterOptions::default()).map_err(|error| error.to_string())?;
    let job = (0..lines).map(|i| format!("G1 X{}.{:03} Y{}.5 E0.0312 ; wall", i % 200, i % 1000, i % 180));
    let now = Duration::ZERO;
    let begin = Instant::now();
    printer.connect(now).map_err(|error| error.to_string())?;
    let mut job = Some(JobStart::new(Box::new(job.map(String::into_bytes))));
    loop {
        while let Some(event) = printer.poll_event() {
            match event {
                Event::Connected { .. } => {}
                Event::Finished(_) => return Ok(lines as f64 / begin.elapsed().as_secs_f64()),
                Event::Stopped { reason, .. } => return Err(reason.to_string()),
                _ => {}
            }
        }
        if let Some(start) = job.take_if(|_| printer.state() == State::Ready) {
            printer.start(now, start).map_err(|error| error.to_string())?;
        }
        answer_at_once(&mut printer, begin.elapsed());
    }
}

fn answer_at_once(printer: &mut Printer, now: Duration) {
    match printer.poll_transmit() {
        Some(bytes) if bytes == b"\n" => {}
        Some(bytes) if bytes.windows(5).any(|w| w == b" M105") => {
            printer.handle_bytes(now, b"ok T:20.0 /0.0\n")
        }
        Some(_) => printer.handle_bytes(now, b"ok\n"),
        None => printer.handle_timeout(now),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["--throughput", lines] => lines
            .parse()
            .map_err(|_| "how many lines?".to_owned())
            .and_then(throughput)
            .map(|speed| println!("{speed:.0} acknowledged lines a second")),
        [path] => std::fs::read_to_string(path)
            .map_err(|error| error.to_string())
            .and_then(|text| replay(&text))
            .map(|sent| println!("{}\nholds: {} lines sent", sent.join("\n"), sent.len())),
        _ => Err("usage: replay_serial TRANSCRIPT | --throughput LINES".to_owned()),
    };
    if let Err(why) = result {
        eprintln!("{why}");
        std::process::exit(1);
    }
}
