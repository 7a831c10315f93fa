// Tilting, turning and raising the map by hand where the automatic start was wrong: tried out in the page, then done by the server.

import { attempt, type Page } from '../page';
import { ImageStream } from '../gen/flogmap/v1/stream_pb';
import type { PoseValue } from '../gen/flogmap/v1/map_pb';
import { between, floorOf, levelByFloor, NO_LEVEL, sameLevel, type Level } from '../level';
import { samplesIn } from '../floor_samples';
import { button } from '../ui/controls';
import { h, setText } from '../ui/dom';

const FIELDS: readonly (readonly [keyof Level, string, number, number, string])[] = [
  ['roll', 'Tilt left up', 45, 0.1, '°'], ['pitch', 'Tilt front down', 45, 0.1, '°'], ['yaw', 'Turn left', 180, 0.5, '°'], ['height', 'Raise', 5, 0.01, 'm'],
];
const PREVIEW_STAYS_MS = 6000; // at most, after applying, until the map has been built anew

export class LevelTool {
  readonly element: HTMLElement;
  private now = NO_LEVEL; // as the server has it
  private wanted = NO_LEVEL;
  private readonly earlier: Level[] = [];
  private obstacle = '';
  private solidBefore = false;
  private applied = 0;
  private readonly words = h('p', { class: 'level-words', role: 'status' });
  private readonly fields: readonly (readonly [keyof Level, HTMLInputElement, HTMLInputElement])[];
  private readonly pick = button('Pick the floor', () => this.togglePicking());
  private readonly apply = button('Apply', () => void this.send(this.wanted, true), 'primary');
  private readonly cancel = button('Cancel', () => this.tryOut(this.now));
  private readonly undo = button('Undo', () => void this.send(this.earlier.pop() ?? NO_LEVEL, false));
  private readonly automatic = button('As it began', () => this.tryOut(NO_LEVEL));

  constructor(private readonly page: Page) {
    this.fields = FIELDS.map(([name, label, most, step, unit]) => {
      const choose = (input: HTMLInputElement): void => this.tryOut({ ...this.wanted, [name]: Math.max(-most, Math.min(most, Number(input.value) || 0)) });
      const slide = h('input', { type: 'range', min: -most, max: most, step, 'aria-label': label, oninput: () => choose(slide) });
      const number = h('input', { type: 'number', min: -most, max: most, step, 'aria-label': `${label}, ${unit === 'm' ? 'metres' : 'degrees'}`, onchange: () => choose(number) });
      return [name, slide, number] as const;
    });
    const rows = this.fields.map(([, slide, number], i) => h('div', { class: 'level-row' }, h('span', {}, FIELDS[i]?.[1] ?? ''), slide, number, h('span', { class: 'unit' }, FIELDS[i]?.[4] ?? '')));
    this.element = h('div', { class: 'level-tool', hidden: true }, h('b', {}, 'Level the map'), this.words, ...rows,
      h('div', { class: 'level-buttons' }, this.pick, this.automatic, this.undo, this.cancel, this.apply));
    page.focus.changed.on(({ now, before }) => {
      if (now.tool !== before.tool) this.changeTool(now.tool === 'level', before.tool === 'level');
      if (now.floor !== before.floor) this.takeFloor();
    });
    page.live.begun.on(() => this.using && void this.ask());
    page.live.trajectoryChanged.on(({ from }) => this.arrived(from === 0, false));
    page.live.tilesChanged.on(() => this.arrived(false, true));
  }

  private get using(): boolean {
    return this.page.focus.get().tool === 'level';
  }

  private changeTool(now: boolean, before: boolean): void {
    this.element.hidden = !now;
    if (now === before) return;
    const { settings, focus } = this.page;
    if (now) {
      this.solidBefore = settings.get().solid;
      settings.set({ solid: true }); // a tilt is seen from the side
      void this.ask();
    } else {
      focus.set({ floor: undefined });
      settings.set({ solid: this.solidBefore });
      this.page.view.tilt(undefined, undefined);
    }
  }

  /** How the server has it now. */
  private async ask(): Promise<void> {
    await attempt(this.page, this.page.backend.level().then(({ level, obstacle }) => {
      this.now = level;
      this.obstacle = this.page.live.role === 'control' ? obstacle : 'levelling needs the role “control”';
    }, (error: unknown) => {
      this.obstacle = error instanceof Error ? error.message : String(error);
    }));
    this.tryOut(this.now);
  }

  /** Shows the map as it would be. */
  private tryOut(level: Level): void {
    this.wanted = level;
    this.applied = 0;
    if (!this.using) return;
    const motion = sameLevel(level, this.now) ? undefined : between(this.now, level);
    this.page.view.tilt(motion, motion);
    this.show();
  }

  private async send(level: Level, remember: boolean): Promise<void> {
    const before = this.now;
    this.tryOut(level);
    this.apply.disabled = true;
    await attempt(this.page, this.page.backend.setLevel(level).then(() => {
      if (remember) this.earlier.push(before);
      this.now = level;
      this.applied = performance.now();
    }));
    this.show();
  }

  /** The server's own picture of it comes: the path at once, the tiles a little later. */
  private arrived(path: boolean, tiles: boolean): void {
    if (!this.applied || !this.using) return;
    const late = performance.now() - this.applied > PREVIEW_STAYS_MS;
    if (path) this.page.view.tilt('as it is', undefined);
    if (!tiles && !late) return;
    this.page.view.tilt(undefined, undefined);
    this.applied = 0;
    this.show();
  }

  private togglePicking(): void {
    const { focus, live } = this.page;
    const can = live.images.has(ImageStream.LEFT) && live.images.has(ImageStream.DISPARITY);
    if (!can) live.noticed.emit({ tone: 'warning', text: 'There are no pictures to pick the floor in. Switch them on in the camera panel.' });
    else focus.set({ floor: focus.get().floor ? undefined : [], sheet: focus.get().sheet === 'none' ? 'none' : 'camera' });
  }

  private takeFloor(): void {
    const { floor } = this.page.focus.get();
    if (this.using && floor?.length === 3) void this.levelByPicked(floor);
    this.show();
  }

  private async levelByPicked(corners: readonly { readonly x: number; readonly y: number }[]): Promise<void> {
    const { live, focus } = this.page;
    const image = live.images.get(ImageStream.DISPARITY);
    const camera = live.camera;
    const pose = image && poseAt(this.page, image.timeNs);
    const samples = image && camera ? await samplesIn(image, corners) : [];
    const floor = camera && floorOf(samples, camera);
    focus.set({ floor: undefined });
    if (!floor || !pose) live.noticed.emit({ tone: 'warning', text: pose ? 'Too little of the floor was measured between these points. Pick them further apart, or where the disparity picture shows something.' : 'The place of the camera is unknown just now.' });
    else this.tryOut(rounded(levelByFloor(floor, pose, this.now)));
  }

  private show(): void {
    for (const [name, slide, number] of this.fields) {
      slide.value = number.value = String(this.wanted[name]);
      const most = Number(slide.max);
      slide.style.setProperty('--filled', `${(50 * (this.wanted[name] + most)) / most}%`);
    }
    const same = sameLevel(this.wanted, this.now);
    const { floor } = this.page.focus.get();
    this.apply.disabled = same || this.obstacle !== '';
    this.cancel.disabled = same;
    this.undo.disabled = this.earlier.length === 0 || this.obstacle !== '';
    this.automatic.disabled = sameLevel(this.wanted, NO_LEVEL);
    this.pick.setAttribute('aria-pressed', String(floor !== undefined));
    setText(this.words, this.text(same, floor?.length));
  }

  private text(same: boolean, picked: number | undefined): string {
    if (picked !== undefined) return `Click three points of the floor in the left picture: ${picked} of 3.`;
    if (this.applied) return 'The map is being built anew …';
    if (this.obstacle) return `Cannot be applied: ${this.obstacle}.`;
    return same ? 'Tilt, turn and raise it until the floor lies level at the grid.' : 'A preview. Apply builds the map anew, for everybody.';
  }
}

/** Where the camera was at that time, as the path now has it. */
function poseAt({ live }: Page, timeNs: bigint): PoseValue | undefined {
  for (let i = live.path.length - 1; i >= 0; --i) {
    const point = live.path.at(i);
    if (point && point.timeNs <= timeNs) return point.pose;
  }
  return live.path.at(0)?.pose;
}

const rounded = ({ roll, pitch, yaw, height }: Level): Level => {
  const to = (value: number, digits: number): number => Number(value.toFixed(digits));
  return { roll: to(roll, 2), pitch: to(pitch, 2), yaw: to(yaw, 2), height: to(height, 3) };
};
