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
      if (index >= 0) interleave(layer, planes.subarray(index * BYTES_PER_LAYER, (index + 1) * BYTES_PER_LAYER));
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

/** Planes one after the other to (E, O, K, C) per cell. With M alone: O = M, E = 1 - M where known is not told, K = 1. */
function interleave(layer: LayerPlanes, into: Uint8Array): void {
  if (layer.planes.case === 'evidence') {
    const evidence = inflate(layer.planes.value, 3 * PLANE);
    for (let plane = 0; plane < 3; ++plane)
      for (let i = 0; i < PLANE; ++i) into[4 * i + plane] = evidence[plane * PLANE + i] ?? 0;
  } else if (layer.planes.case === 'value') {
    const value = inflate(layer.planes.value, PLANE);
    for (let i = 0; i < PLANE; ++i) into.set([255 - (value[i] ?? 0), value[i] ?? 0, 255], 4 * i);
  }
  if (layer.change.length === 0) return;
  const change = inflate(layer.change, PLANE);
  for (let i = 0; i < PLANE; ++i) into[4 * i + 3] = change[i] ?? 0;
}

function inflate(deflated: Uint8Array, size: number): Uint8Array {
  const bytes = unzlibSync(deflated);
  if (bytes.length !== size) throw new Error(`a plane has ${bytes.length} bytes, not ${size}`);
  return bytes;
}
