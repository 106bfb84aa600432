//! PNG from RGBA pixels (W3C, "Portable Network Graphics", third edition), small in code rather than
//! in bytes: rows are filtered to differences (filter Sub), and runs of equal bytes are packed with
//! DEFLATE's fixed codes (RFC 1951, section 3.2.6). A library that also finds other repeats would save a
//! third of the bytes of a thumbnail and cost ten times the code.

/// Bytes of a pixel.
const PIXEL: usize = 4;

/// Longest run that one code can repeat.
const LONGEST_RUN: usize = 258;

/// The picture as a file: 8 bits for each of red, green, blue and alpha, rows from the top.
pub fn png(pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    // 8 bits, RGBA, deflate, adaptive filters, not interlaced.
    header.extend([8, 6, 0, 0, 0]);
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"IDAT", &zlib(&filtered(pixels, width as usize * PIXEL)));
    chunk(&mut file, b"IEND", &[]);
    file
}

fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    file.extend((data.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(data);
    let check = crc32(&file[start..]);
    file.extend(check.to_be_bytes());
}

/// Each row with its filter, Sub, before it: every byte less the one a pixel to the left.
fn filtered(pixels: &[u8], row_bytes: usize) -> Vec<u8> {
    const SUB: u8 = 1;
    let mut rows = Vec::with_capacity(pixels.len() + pixels.len() / row_bytes.max(1));
    for row in pixels.chunks(row_bytes.max(1)) {
        rows.push(SUB);
        let left = |i: usize| if i < PIXEL { 0 } else { row[i - PIXEL] };
        rows.extend(row.iter().enumerate().map(|(i, byte)| byte.wrapping_sub(left(i))));
    }
    rows
}

/// CRC-32 of PNG's annex D.
fn crc32(bytes: &[u8]) -> u32 {
    let of_byte = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    };
    !bytes.iter().fold(u32::MAX, of_byte)
}

/// A zlib stream (RFC 1950) of one block with fixed codes.
fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut bits = Bits { bytes: vec![0x78, 0x01], pending: 0, count: 0 };
    // Last block, fixed codes.
    bits.put(0b011, 3);
    let mut at = 0;
    while at < bytes.len() {
        literal(&mut bits, u32::from(bytes[at]));
        let run = bytes[at + 1..].iter().take(LONGEST_RUN).take_while(|b| **b == bytes[at]).count();
        // Shorter runs have no code.
        if run >= 3 {
            repeat(&mut bits, run as u32);
            at += run;
        }
        at += 1;
    }
    const END_OF_BLOCK: u32 = 256;
    literal(&mut bits, END_OF_BLOCK);
    let mut stream = bits.finish();
    stream.extend(adler32(bytes).to_be_bytes());
    stream
}

/// Adler-32 of RFC 1950, section 8.2.
fn adler32(bytes: &[u8]) -> u32 {
    const MODULUS: u32 = 65521;
    let (a, b) = bytes.iter().fold((1, 0), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % MODULUS;
        (a, (b + a) % MODULUS)
    });
    b << 16 | a
}

/// A code of the literal and length alphabet.
fn literal(bits: &mut Bits, code: u32) {
    match code {
        0..=143 => bits.put_code(0x30 + code, 8),
        144..=255 => bits.put_code(0x190 + code - 144, 9),
        256..=279 => bits.put_code(code - 256, 7),
        _ => bits.put_code(0xc0 + code - 280, 8),
    }
}

/// The byte before, `run` times (3 to 258): a length code with its extra bits, and the distance 1.
fn repeat(bits: &mut Bits, run: u32) {
    let extra = run - 3;
    match (run, extra) {
        (258, _) => literal(bits, 285),
        (_, 0..=7) => literal(bits, 257 + extra),
        _ => {
            let width = extra.ilog2() - 2;
            literal(bits, 257 + 4 * width + (extra >> width));
            bits.put(extra & ((1 << width) - 1), width);
        }
    }
    bits.put_code(0, 5);
}

/// Bits from the lowest of each byte up.
struct Bits {
    bytes: Vec<u8>,
    pending: u32,
    count: u32,
}

impl Bits {
    fn put(&mut self, value: u32, width: u32) {
        self.pending |= value << self.count;
        self.count += width;
        while self.count >= 8 {
            self.bytes.push(self.pending as u8);
            self.pending >>= 8;
            self.count -= 8;
        }
    }

    /// Codes come with their highest bit first.
    fn put_code(&mut self, code: u32, width: u32) {
        self.put(code.reverse_bits() >> (32 - width), width);
    }

    fn finish(mut self) -> Vec<u8> {
        self.put(0, 7);
        self.bytes
    }
}
