// What part of the world the flat map shows: metres to pixels and back. Pure; y is up in the world, down on the screen.

export interface Rect {
  readonly xMin: number;
  readonly yMin: number;
  readonly xMax: number;
  readonly yMax: number;
}

export interface Point {
  readonly x: number;
  readonly y: number;
}

export interface Viewport {
  /** World point in the middle of the screen, metres. */
  readonly x: number;
  readonly y: number;
  /** CSS pixels per metre, > 0. */
  readonly scale: number;
  /** World direction that points up on the screen, radians counter-clockwise from +y; 0 = north up. */
  readonly turn: number;
  /** Size of the screen, CSS pixels. */
  readonly width: number;
  readonly height: number;
}

export const MIN_SCALE = 0.5;
export const MAX_SCALE = 4000;

const clampScale = (scale: number): number => Math.min(MAX_SCALE, Math.max(MIN_SCALE, scale));

export function screenFromWorld(view: Viewport, world: Point): Point {
  const dx = (world.x - view.x) * view.scale;
  const dy = (world.y - view.y) * view.scale;
  const c = Math.cos(view.turn);
  const s = Math.sin(view.turn);
  return { x: view.width / 2 + c * dx + s * dy, y: view.height / 2 + s * dx - c * dy };
}

export function worldFromScreen(view: Viewport, screen: Point): Point {
  const u = (screen.x - view.width / 2) / view.scale;
  const v = (view.height / 2 - screen.y) / view.scale;
  const c = Math.cos(view.turn);
  const s = Math.sin(view.turn);
  return { x: view.x + c * u - s * v, y: view.y + s * u + c * v };
}

/** Moves the picture by (dx, dy) CSS pixels. */
export function pan(view: Viewport, dx: number, dy: number): Viewport {
  const middle = worldFromScreen(view, { x: view.width / 2 - dx, y: view.height / 2 - dy });
  return { ...view, x: middle.x, y: middle.y };
}

/** Zooms by `factor`; the world point under `screen` stays where it is. */
export function zoomAt(view: Viewport, factor: number, screen: Point): Viewport {
  return keepUnder({ ...view, scale: clampScale(view.scale * factor) }, worldFromScreen(view, screen), screen);
}

/** Turns the picture by `angle` radians about the world point under `screen`. */
export function turnAt(view: Viewport, angle: number, screen: Point): Viewport {
  return keepUnder({ ...view, turn: wrapAngle(view.turn + angle) }, worldFromScreen(view, screen), screen);
}

function keepUnder(view: Viewport, world: Point, screen: Point): Viewport {
  const now = worldFromScreen(view, screen);
  return { ...view, x: view.x + world.x - now.x, y: view.y + world.y - now.y };
}

/** Shows all of `rect` with `margin` CSS pixels around it. */
export function fit(view: Viewport, rect: Rect, margin: number): Viewport {
  const c = Math.abs(Math.cos(view.turn));
  const s = Math.abs(Math.sin(view.turn));
  const w = rect.xMax - rect.xMin;
  const h = rect.yMax - rect.yMin;
  const roomX = Math.max(40, view.width - 2 * margin);
  const roomY = Math.max(40, view.height - 2 * margin);
  const scale = Math.min(roomX / Math.max(1e-6, c * w + s * h), roomY / Math.max(1e-6, s * w + c * h));
  return { ...view, x: (rect.xMin + rect.xMax) / 2, y: (rect.yMin + rect.yMax) / 2, scale: clampScale(scale) };
}

/** The smallest axis-aligned world rectangle that holds everything on the screen. */
export function visibleRect(view: Viewport): Rect {
  const c = Math.abs(Math.cos(view.turn));
  const s = Math.abs(Math.sin(view.turn));
  const halfX = (c * view.width + s * view.height) / 2 / view.scale;
  const halfY = (s * view.width + c * view.height) / 2 / view.scale;
  return { xMin: view.x - halfX, yMin: view.y - halfY, xMax: view.x + halfX, yMax: view.y + halfY };
}

/** The overview level whose cells are at least a pixel wide, of `levels`; nothing thin may fall between pixels. */
export function levelFor(view: Viewport, cellSize: number, levels: number, pixelRatio = 1): number {
  const cellsPerPixel = 1 / (cellSize * view.scale * pixelRatio);
  return Math.min(Math.max(0, levels - 1), Math.max(0, Math.ceil(Math.log2(cellsPerPixel) - 1e-9)));
}

/** A round length for a scale bar or grid: the largest 1, 2 or 5 times a power of ten that is at most `metres`. */
export function roundLength(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  const digit = metres / power;
  return (digit >= 5 - 1e-9 ? 5 : digit >= 2 - 1e-9 ? 2 : 1) * power;
}

/** Lengths in words as short as they are exact: "2 cm", "50 cm", "5 m", "1 km". */
export function formatLength(metres: number): string {
  const trim = (value: number, digits: number): string => String(Number(value.toFixed(digits)));
  if (metres < 0.01) return `${trim(metres * 1000, 1)} mm`;
  if (metres < 1) return `${trim(metres * 100, 1)} cm`;
  if (metres < 1000) return `${trim(metres, 2)} m`;
  return `${trim(metres / 1000, 2)} km`;
}

/** The same angle in (-pi, pi]. */
export function wrapAngle(angle: number): number {
  const turned = angle % (2 * Math.PI);
  if (turned > Math.PI) return turned - 2 * Math.PI;
  return turned <= -Math.PI ? turned + 2 * Math.PI : turned;
}

/** Part `t` of the way to another view; of the same size. */
export function towards(from: Viewport, to: Viewport, t: number): Viewport {
  return {
    ...from, x: from.x + (to.x - from.x) * t, y: from.y + (to.y - from.y) * t,
    scale: from.scale * (to.scale / from.scale) ** t, turn: wrapAngle(from.turn + wrapAngle(to.turn - from.turn) * t),
  };
}

/** How much two views differ, about in CSS pixels. */
export const pixelsApart = (a: Viewport, b: Viewport): number =>
  Math.max(Math.hypot(b.x - a.x, b.y - a.y) * a.scale, Math.abs(b.scale / a.scale - 1) * 300, Math.abs(wrapAngle(b.turn - a.turn)) * 300);
