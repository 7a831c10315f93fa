// Draws the tiles on screen: one instanced quad per tile, one draw call per page of textures.

import { BufferAttribute, Group, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, type BufferGeometry, type ShaderMaterial } from 'three';
import { quartersToDraw } from '../tile_choice';
import { tileSide, type Tile } from '../tile_store';
import { tileMaterial, type MapUniforms, type TileRules } from './map_material';
import type { TilePages } from './tile_pages';

export function unitQuad(): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.instanceCount = 1;
  return geometry;
}

export class TileMeshes {
  readonly group = new Group();
  private meshes: Mesh<BufferGeometry, ShaderMaterial>[] = [];
  private readonly uniforms: MapUniforms;

  /** `only`: paint this layer alone, translucent. */
  constructor(private readonly pages: TilePages, uniforms: MapUniforms, private rules: TileRules, private readonly only = -1) {
    this.uniforms = { ...uniforms, uOnly: { value: only }, uHeight: { value: 0 } };
  }

  setHeight(metres: number): void {
    if (this.uniforms['uHeight']) this.uniforms['uHeight'].value = metres;
  }

  setRules(rules: TileRules): void {
    if (Object.entries(rules).every(([name, value]) => this.rules[name] === value)) return;
    this.rules = rules;
    for (const { material } of this.meshes) {
      Object.assign(material.defines, rules);
      material.needsUpdate = true;
    }
  }

  /** Takes the tiles that are to be seen, in the order of drawing; of those coarser than `level` what no finer one shows. */
  show(tiles: readonly Tile[], level: number, cellSize: number): void {
    while (this.meshes.length < this.pages.pages.length) this.addMesh();
    const perPage = this.meshes.map((): number[] => []);
    for (const tile of tiles) {
      const slot = this.pages.slotOf(tile);
      if (!slot) continue;
      const side = tileSide(tile.level, cellSize);
      const quarters = quartersToDraw(tile, level, (key) => this.pages.slotOf(key) !== undefined);
      if (quarters.length === 4) perPage[slot.page]?.push(tile.x * side, tile.y * side, side, slot.index);
      else for (const quarter of quarters) perPage[slot.page]?.push(tile.x * side, tile.y * side, side, slot.index + (quarter + 1) / 8);
    }
    this.meshes.forEach((mesh, page) => this.fill(mesh, perPage[page] ?? []));
  }

  dispose(): void {
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.group.clear();
    this.meshes = [];
  }

  private addMesh(): void {
    const page = this.pages.pages[this.meshes.length];
    if (!page) return;
    const mesh = new Mesh<BufferGeometry, ShaderMaterial>(unitQuad(), tileMaterial(this.uniforms, page, this.rules, this.only >= 0));
    mesh.frustumCulled = false;
    this.meshes.push(mesh);
    this.group.add(mesh);
  }

  private fill(mesh: Mesh<BufferGeometry, ShaderMaterial>, values: number[]): void {
    const geometry = mesh.geometry as InstancedBufferGeometry;
    const old = geometry.getAttribute('tile') as InstancedBufferAttribute | undefined;
    if (old && old.array.length >= values.length) {
      (old.array as Float32Array).set(values);
      old.needsUpdate = true;
    } else {
      const room = new Float32Array(Math.max(64, values.length * 2));
      room.set(values);
      geometry.dispose(); // the buffer grows: let go of the old one
      geometry.setAttribute('tile', new InstancedBufferAttribute(room, 4));
    }
    geometry.instanceCount = values.length / 4;
    mesh.visible = values.length > 0;
  }
}
