//! QOI from RGBA pixels ("The Quite OK Image Format Specification", version 1.0, qoiformat.org).

/// The picture as a file with four channels, sRGB with linear alpha, rows from the top.
pub fn qoi(pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut file = b"qoif".to_vec();
    file.extend([width.to_be_bytes(), height.to_be_bytes()].concat());
    file.extend([4, 0]);
    let mut seen = [[0_u8; 4]; 64];
    let mut last = [0, 0, 0, 255];
    let mut run = 0_u8;
    for pixel in pixels.chunks_exact(4) {
        let pixel = [pixel[0], pixel[1], pixel[2], pixel[3]];
        if pixel == last {
            run += 1;
            // 63 and 64 would read as whole pixels.
            if run == 62 {
                end_run(&mut file, &mut run);
            }
            continue;
        }
        end_run(&mut file, &mut run);
        let [r, g, b, a] = pixel.map(usize::from);
        let place = (r * 3 + g * 5 + b * 7 + a * 11) % 64;
        if seen[place] == pixel {
            file.push(place as u8);
        } else {
            seen[place] = pixel;
            change(&mut file, last, pixel);
        }
        last = pixel;
    }
    end_run(&mut file, &mut run);
    file.extend([0, 0, 0, 0, 0, 0, 0, 1]);
    file
}

fn end_run(file: &mut Vec<u8>, run: &mut u8) {
    if *run > 0 {
        file.push(0b1100_0000 | (*run - 1));
    }
    *run = 0;
}

/// A pixel by its difference from the last one, or whole.
fn change(file: &mut Vec<u8>, last: [u8; 4], [r, g, b, a]: [u8; 4]) {
    if a != last[3] {
        return file.extend([0b1111_1111, r, g, b, a]);
    }
    let [dr, dg, db] = [r.wrapping_sub(last[0]), g.wrapping_sub(last[1]), b.wrapping_sub(last[2])];
    // Differences are stored with an offset, so that they begin at 0.
    let small = [dr, dg, db].map(|d| d.wrapping_add(2));
    if small.iter().all(|&d| d < 4) {
        return file.push(0b0100_0000 | small[0] << 4 | small[1] << 2 | small[2]);
    }
    let green = dg.wrapping_add(32);
    let beside = [dr, db].map(|d| d.wrapping_sub(dg).wrapping_add(8));
    if green < 64 && beside.iter().all(|&d| d < 16) {
        return file.extend([0b1000_0000 | green, beside[0] << 4 | beside[1]]);
    }
    file.extend([0b1111_1110, r, g, b]);
}
