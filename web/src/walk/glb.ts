// Reads the one kind of GLB that the server makes of a view: one mesh, one JPEG. Pure; Khronos glTF 2.0, section 4.4.

export interface ViewMesh {
  /** Metres in the camera: x right, y down, z forward. */
  readonly positions: Float32Array<ArrayBuffer>;
  /** 0 .. 65535 across the picture, from its upper left corner. */
  readonly texture: Uint16Array<ArrayBuffer>;
  readonly indices: Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer>;
  readonly jpeg: Uint8Array<ArrayBuffer>;
}

const MAGIC = 0x46546c67;
const UNSIGNED_INT = 5125;

interface Document {
  readonly meshes?: readonly { readonly primitives: readonly { readonly attributes: Record<string, number>; readonly indices: number }[] }[];
  readonly accessors?: readonly { readonly bufferView: number; readonly componentType: number; readonly count: number }[];
  readonly bufferViews?: readonly { readonly byteOffset?: number; readonly byteLength: number }[];
  readonly images?: readonly { readonly bufferView: number }[];
}

/** Nothing for a view without a surface; throws what is wrong with bytes that are no such file. */
export function readGlb(bytes: ArrayBuffer): ViewMesh | undefined {
  const data = new DataView(bytes);
  if (bytes.byteLength < 20 || data.getUint32(0, true) !== MAGIC || data.getUint32(8, true) !== bytes.byteLength) throw new Error('not a GLB file');
  const jsonLength = data.getUint32(12, true);
  const document = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 20, jsonLength))) as Document;
  const primitive = document.meshes?.[0]?.primitives[0];
  if (!primitive) return undefined;
  const start = 20 + jsonLength + 8; // of the binary chunk's data
  const part = (view: number): { at: number; length: number } => {
    const described = document.bufferViews?.[view];
    const at = start + (described?.byteOffset ?? 0);
    if (!described || at + described.byteLength > bytes.byteLength) throw new Error('a GLB file that ends too soon');
    return { at, length: described.byteLength };
  };
  const accessor = (index: number | undefined): { at: number; count: number; componentType: number } => {
    const described = document.accessors?.[index ?? -1];
    if (!described) throw new Error('a GLB file without its parts');
    return { at: part(described.bufferView).at, count: described.count, componentType: described.componentType };
  };
  const position = accessor(primitive.attributes['POSITION']);
  const texture = accessor(primitive.attributes['TEXCOORD_0']);
  const index = accessor(primitive.indices);
  const picture = part(document.images?.[0]?.bufferView ?? -1);
  const Indices = index.componentType === UNSIGNED_INT ? Uint32Array : Uint16Array;
  return {
    positions: new Float32Array(bytes, position.at, 3 * position.count),
    texture: new Uint16Array(bytes, texture.at, 2 * texture.count),
    indices: new Indices(bytes, index.at, index.count),
    jpeg: new Uint8Array(bytes, picture.at, picture.length),
  };
}
