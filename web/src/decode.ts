// Bytes of the stream to what the page works with. Pure; runs in the worker, so that inflating never stops the drawing.

import { fromBinary } from '@bufbuild/protobuf';
import { unzlibSync } from 'fflate';
import type { LayerPlanes, MapInfo, Tile as WireTile } from './gen/flogmap/v1/map_pb';
import { ServerMessageSchema, type ImageStream, type ServerMessage } from './gen/flogmap/v1/stream_pb';
import { BYTES_PER_LAYER, TILE_SIDE, type Tile, type TileKey } from './tile_store';

export interface TilesEvent {
  readonly kind: 'tiles';
  readonly rev: bigint;
  /** After this, every tile as of `rev` is here. */
  readonly complete: boolean;
  readonly tiles: Tile[];
  readonly removed: TileKey[];
}

export interface ImageEvent {
  readonly kind: 'image';
  readonly stream: ImageStream;
  readonly timeNs: bigint;
  readonly mediaType: string;
  readonly data: Uint8Array<ArrayBuffer>;
  readonly scale: readonly [number, number];
  readonly size: readonly [number, number];
  readonly fullSize: readonly [number, number];
}

type Plain = Exclude<ServerMessage['message'], { case: 'tileBatch' | 'imageFrame' | undefined }>;

/** Messages without bulk go through as they are. */
export type StreamEvent = TilesEvent | ImageEvent | { readonly kind: 'message'; readonly message: Plain } | { readonly kind: 'unknown' };

const PLANE = TILE_SIDE * TILE_SIDE;

export class Decoder {
  private layerIds: number[] = [];

  /** Throws if the bytes are not a ServerMessage or a plane has the wrong size. */
  decode(bytes: Uint8Array): StreamEvent {
    const { message } = fromBinary(ServerMessageSchema, bytes);
    switch (message.case) {
      case 'tileBatch':
        return {
          kind: 'tiles', rev: message.value.rev, complete: message.value.complete,
          tiles: message.value.tiles.map((tile) => this.tile(tile)), removed: message.value.removed.map(plainKey),
        };
      case 'imageFrame': {
        const f = message.value;
        return {
          kind: 'image', stream: f.stream, timeNs: f.timeNs, mediaType: f.mediaType, data: f.data.slice(),
          scale: [f.scaleMin, f.scaleMax], size: [f.width, f.height], fullSize: [f.fullWidth, f.fullHeight],
        };
      }
      case undefined:
        return { kind: 'unknown' }; // of a newer server
      case 'welcome':
      case 'reset':
        this.rememberLayers(message.value.map);
        return { kind: 'message', message };
      default:
        return { kind: 'message', message };
    }
  }

  private rememberLayers(map: MapInfo | undefined): void {
    this.layerIds = map?.layers.map((layer) => layer.id) ?? [];
  }

  private tile(wire: WireTile): Tile {
    const planes = new Uint8Array(this.layerIds.length * BYTES_PER_LAYER);
    for (const layer of wire.layers) {
      const index = this.layerIds.indexOf(layer.layer);
      if (index >= 0) interleave(layer, new Uint32Array(planes.buffer, index * BYTES_PER_LAYER, PLANE));
    }
    return { ...plainKey(wire.key), rev: wire.rev, planes };
  }
}

/** What of an event can be moved between threads instead of copied. */
export function transferables(event: StreamEvent): ArrayBuffer[] {
  if (event.kind === 'tiles') return event.tiles.map((tile) => tile.planes.buffer as ArrayBuffer);
  return event.kind === 'image' ? [event.data.buffer] : [];
}

const plainKey = (key: { level: number; x: number; y: number } | undefined): TileKey => ({ level: key?.level ?? 0, x: key?.x ?? 0, y: key?.y ?? 0 });

const LITTLE_ENDIAN = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;
const SHIFTS = LITTLE_ENDIAN ? [0, 8, 16, 24] : [24, 16, 8, 0]; // of E, O, K, C in a word
const [toE = 0, toO = 0, toK = 0, toC = 0] = SHIFTS;
// Used again for every plane; one byte more than fits, so that a plane that is too long is noticed.
const scratch = { planes: new Uint8Array(3 * PLANE + 1), change: new Uint8Array(PLANE + 1) };
const NONE = new Uint8Array(PLANE);

/** Planes one after the other to (E, O, K, C) per cell, a word each. With M alone: O = M, E = 1 - M where known is not told, K = 1. */
function interleave(layer: LayerPlanes, into: Uint32Array): void {
  const change = layer.change.length > 0 ? inflate(layer.change, scratch.change, PLANE) : NONE;
  if (layer.planes.case === 'evidence') {
    const planes = inflate(layer.planes.value, scratch.planes, 3 * PLANE);
    for (let i = 0; i < PLANE; ++i) {
      into[i] = ((planes[i] ?? 0) << toE) | ((planes[PLANE + i] ?? 0) << toO) | ((planes[2 * PLANE + i] ?? 0) << toK) | ((change[i] ?? 0) << toC);
    }
  } else {
    const known = layer.planes.case === 'value';
    const values = known ? inflate(layer.planes.value as Uint8Array, scratch.planes, PLANE) : NONE;
    for (let i = 0; i < PLANE; ++i) {
      const value = values[i] ?? 0;
      into[i] = (known ? ((255 - value) << toE) | (value << toO) | (255 << toK) : 0) | ((change[i] ?? 0) << toC);
    }
  }
}

/** Throws if it is not just `size` bytes. */
function inflate(deflated: Uint8Array, into: Uint8Array, size: number): Uint8Array {
  const bytes = unzlibSync(deflated, { out: into.subarray(0, size + 1) });
  if (bytes.length !== size) throw new Error(`a plane has ${bytes.length} bytes, not ${size}`);
  return bytes;
}
