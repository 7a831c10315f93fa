import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { create, toBinary, type MessageInitShape } from '@bufbuild/protobuf';
import { zlibSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { Decoder, transferables } from './decode';
import { ServerMessageSchema } from './gen/flogmap/v1/stream_pb';
import { BYTES_PER_LAYER } from './tile_store';

type Message = NonNullable<MessageInitShape<typeof ServerMessageSchema>['message']>;
const bytes = (message: Message): Uint8Array => toBinary(ServerMessageSchema, create(ServerMessageSchema, { message }));
const welcome = bytes({ case: 'welcome', value: { version: 1, map: { epoch: 'e', layers: [{ id: 4 }, { id: 2 }] } } });
const PLANE = 4096;

function decoder(): Decoder {
  const made = new Decoder();
  made.decode(welcome);
  return made;
}

describe('decoder', () => {
  it('puts E, O, K and C of every layer side by side, in the order of the map’s layers', () => {
    const evidence = new Uint8Array(3 * PLANE);
    evidence.set([11], 5);
    evidence.set([22], PLANE + 5);
    evidence.set([33], 2 * PLANE + 5);
    const change = new Uint8Array(PLANE);
    change[5] = 44;
    const event = decoder().decode(bytes({
      case: 'tileBatch',
      value: { rev: 9n, complete: true, tiles: [{ key: { level: 1, x: -2, y: 3 }, rev: 8n, layers: [{ layer: 2, planes: { case: 'evidence', value: zlibSync(evidence) }, change: zlibSync(change) }] }] },
    }));
    if (event.kind !== 'tiles') throw new Error('no tiles');
    const [tile] = event.tiles;
    expect(tile).toMatchObject({ level: 1, x: -2, y: 3, rev: 8n });
    expect(tile?.planes.length).toBe(2 * BYTES_PER_LAYER);
    expect(Array.from(tile?.planes.subarray(BYTES_PER_LAYER + 20, BYTES_PER_LAYER + 24) ?? [])).toEqual([11, 22, 33, 44]);
    expect(tile?.planes.subarray(0, BYTES_PER_LAYER).every((value) => value === 0)).toBe(true);
    expect(transferables(event)).toEqual([tile?.planes.buffer]);
  });

  it('refuses planes of a wrong size and bytes that are no message', () => {
    const short = bytes({ case: 'tileBatch', value: { tiles: [{ rev: 1n, layers: [{ layer: 4, planes: { case: 'evidence', value: zlibSync(new Uint8Array(100)) } }] }] } });
    expect(() => decoder().decode(short)).toThrow(/100 bytes/);
    expect(() => decoder().decode(new Uint8Array([255, 255, 255]))).toThrow();
  });

  it('takes a picture out of its frame, so that the frame can be freed', () => {
    const frame = bytes({ case: 'imageFrame', value: { stream: 1, mediaType: 'image/jpeg', data: new Uint8Array([1, 2, 3]), width: 4, height: 3 } });
    const event = decoder().decode(frame);
    if (event.kind !== 'image') throw new Error('no picture');
    expect(Array.from(event.data)).toEqual([1, 2, 3]);
    expect(event.data.buffer.byteLength).toBe(3);
  });

  it('lets a message of a newer server pass', () => {
    expect(decoder().decode(new Uint8Array(0)).kind).toBe('unknown');
  });
});

const golden = new URL('../../tests/golden/wire/', import.meta.url);
describe.skipIf(!existsSync(golden))('golden samples of the wire', () => {
  const files = existsSync(golden) ? readdirSync(golden).filter((name) => name.startsWith('server') && name.endsWith('.bin')) : [];
  it.each(files)('%s', (name) => {
    const made = decoder();
    const welcomed = files.find((file) => file.includes('welcome'));
    if (welcomed) made.decode(readFileSync(new URL(welcomed, golden)));
    expect(made.decode(readFileSync(new URL(name, golden))).kind).not.toBe('unknown');
  });
});
