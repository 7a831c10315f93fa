// Tiles on the graphics card: array textures whose slices are planes of (E, O, K, C), one slice per tile and layer.
// A tile that changed is uploaded alone; nothing is kept twice in memory.

import { Data3DTexture, DataArrayTexture, NearestFilter, RGBAFormat, UnsignedByteType, Vector3, type WebGLRenderer } from 'three';
import { BYTES_PER_LAYER, keyText, TILE_SIDE, type Tile, type TileKey } from '../tile_store';

const SLOTS_PER_PAGE = 128;
const MAX_SLICES = 2048; // every WebGL 2 device we know of has as many; the least allowed is 256

export interface Slot {
  readonly page: number;
  readonly index: number;
}

export class TilePages {
  readonly pages: DataArrayTexture[] = [];
  private slots = new Map<string, Slot>();
  private free: Slot[] = [];

  constructor(private readonly renderer: WebGLRenderer, private readonly layers: number) {}

  get slotsPerPage(): number {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const slices = Math.min(MAX_SLICES, gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number);
    return Math.max(1, Math.min(SLOTS_PER_PAGE, Math.floor(slices / this.layers)));
  }

  /** What the textures take on the graphics card, used or not. */
  get bytes(): number {
    return this.pages.length * this.slotsPerPage * this.layers * BYTES_PER_LAYER;
  }

  slotOf(key: TileKey): Slot | undefined {
    return this.slots.get(keyText(key));
  }

  upload(tile: Tile): void {
    const slot = this.slots.get(keyText(tile)) ?? this.take(keyText(tile));
    const page = this.pages[slot.page];
    if (!page) return;
    const planes = new Data3DTexture(tile.planes, TILE_SIDE, TILE_SIDE, this.layers); // only carries the bytes
    planes.format = RGBAFormat;
    planes.type = UnsignedByteType;
    this.renderer.copyTextureToTexture(planes, page, null, new Vector3(0, 0, slot.index * this.layers));
  }

  release(key: TileKey): void {
    const slot = this.slots.get(keyText(key));
    if (!slot) return;
    this.slots.delete(keyText(key));
    this.free.push(slot);
  }

  dispose(): void {
    for (const page of this.pages) page.dispose();
    this.pages.length = 0;
    this.slots.clear();
    this.free = [];
  }

  private take(key: string): Slot {
    if (this.free.length === 0) this.addPage();
    const slot = this.free.pop() ?? { page: 0, index: 0 };
    this.slots.set(key, slot);
    return slot;
  }

  private addPage(): void {
    const count = this.slotsPerPage;
    const texture = new DataArrayTexture(null, TILE_SIDE, TILE_SIDE, count * this.layers);
    texture.format = RGBAFormat;
    texture.type = UnsignedByteType;
    texture.minFilter = texture.magFilter = NearestFilter;
    texture.source.dataReady = false; // storage only; tiles are written into it one by one
    texture.needsUpdate = true;
    const page = this.pages.push(texture) - 1;
    for (let index = count - 1; index >= 0; --index) this.free.push({ page, index });
  }
}
