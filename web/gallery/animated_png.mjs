// Puts PNG pictures of one size behind one another as an animated PNG (PNG, third edition, section 11.3.6).

const SIGNATURE = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);

/** `pictures`: PNG files as buffers; every one is shown for `ms`. Plays for ever. */
export function animatedPng(pictures, ms) {
  const header = chunksOf(pictures[0]).find(({ type }) => type === 'IHDR').data;
  const control = Buffer.alloc(8);
  control.writeUInt32BE(pictures.length, 0);
  const parts = [SIGNATURE, chunk('IHDR', header), chunk('acTL', control)];
  let sequence = 0;
  pictures.forEach((picture, index) => {
    parts.push(chunk('fcTL', frameControl(sequence++, header, ms)));
    for (const { type, data } of chunksOf(picture)) {
      if (type !== 'IDAT') continue;
      parts.push(index === 0 ? chunk('IDAT', data) : chunk('fdAT', Buffer.concat([number(sequence++), data])));
    }
  });
  return Buffer.concat([...parts, chunk('IEND', Buffer.alloc(0))]);
}

function chunksOf(png) {
  const chunks = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
    chunks.push({ type: png.toString('latin1', at + 4, at + 8), data: png.subarray(at + 8, at + 8 + png.readUInt32BE(at)) });
  return chunks;
}

function frameControl(sequence, header, ms) {
  const control = Buffer.alloc(26); // offsets, dispose and blend stay 0
  control.writeUInt32BE(sequence, 0);
  header.copy(control, 4, 0, 8); // width and height
  control.writeUInt16BE(ms, 20);
  control.writeUInt16BE(1000, 22);
  return control;
}

const number = (value) => {
  const bytes = Buffer.alloc(4);
  bytes.writeUInt32BE(value >>> 0, 0);
  return bytes;
};

const chunk = (type, data) => {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  return Buffer.concat([number(data.length), body, number(crc(body))]);
};

const TABLE = Uint32Array.from({ length: 256 }, (_, i) => {
  let c = i;
  for (let k = 0; k < 8; ++k) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
  return c;
});

/** CRC-32 of PNG, section 5.5. */
function crc(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) c = TABLE[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}
