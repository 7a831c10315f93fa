// The robot's way and where it can get to at all, kept up to date while map, radius and height change.

import type { Reach, Route } from '../backend';
import { attempt, type Page } from '../page';
import { h, setText } from '../ui/dom';
import { slider, toggle } from '../ui/controls';
import type { Point } from '../viewport';

const AFRESH_EVERY_MS = 2000; // at most, while the map changes

export class RobotTool {
  readonly element: HTMLElement;
  from: Point | undefined;
  to: Point | undefined;
  route: Route | undefined;
  private reach: Reach | undefined;
  private reachWanted = false;
  private fromCamera = true;
  private trouble = '';
  private askedAt = 0;
  private timer = 0;
  private readonly words = h('span', { class: 'robot-words' });

  constructor(private readonly page: Page, private readonly redraw: () => void) {
    const { settings } = page;
    const radius = slider('Robot radius', { min: 0.05, max: 1, step: 0.05 }, (value) => `${value.toFixed(2)} m`, (robotRadius) => settings.set({ robotRadius }));
    const height = slider('Robot height', { min: 0, max: 2.5, step: 0.05 }, (value) => (value === 0 ? 'all layers' : `${value.toFixed(2)} m`), (robotHeight) => settings.set({ robotHeight }));
    const camera = toggle('Start at the camera', (on) => this.startAtCamera(on), 'The first click says where to go; otherwise it says where to start');
    const reachable = toggle('Show where it can get to', (on) => this.wantReach(on), 'From the start of the route, or else from the camera');
    this.element = h('div', { class: 'robot-tool' }, this.words, camera.element, radius.element, height.element, reachable.element);
    camera.show(true);
    reachable.show(false);
    settings.watch(['robotRadius', 'robotHeight'], (now) => {
      radius.show(now.robotRadius);
      height.show(now.robotHeight);
      this.askSoon(150);
    });
    page.live.tilesChanged.on(() => this.askSoon(AFRESH_EVERY_MS));
    page.live.begun.on(() => this.clear());
  }

  click(world: Point): void {
    if (this.fromCamera) this.to = world;
    else if (!this.from || this.to) Object.assign(this, { from: world, to: undefined, route: undefined, trouble: '' });
    else this.to = world;
    void this.ask(true);
  }

  back(): boolean {
    const had = (this.from ?? this.to) !== undefined;
    Object.assign(this, this.to ? { to: undefined, route: undefined } : { from: undefined });
    this.show();
    return had;
  }

  clear(): void {
    Object.assign(this, { from: undefined, to: undefined, route: undefined, trouble: '' });
    this.show();
  }

  show(): void {
    const using = this.page.focus.get().tool === 'route';
    this.page.view.showReach(using && this.reachWanted ? this.reach : undefined);
    setText(this.words, this.text());
    this.redraw();
  }

  private text(): string {
    const area = this.reachWanted && this.reach ? ` Reaches ${this.reach.areaM2.toFixed(1)} m².` : '';
    if (this.trouble) return `${this.trouble}${area}`;
    if (this.route) return `Route: ${this.route.lengthM.toFixed(2)} m, least clearance ${this.route.clearanceM.toFixed(2)} m.${area}`;
    return `${this.from || this.fromCamera ? 'Route: click where to go.' : 'Route: click where to start.'}${area}`;
  }

  private startAtCamera(on: boolean): void {
    this.fromCamera = on;
    this.clear();
    void this.ask(true);
  }

  private wantReach(on: boolean): void {
    this.reachWanted = on;
    void this.ask(true);
  }

  private askSoon(wait: number): void {
    if (this.timer || this.page.focus.get().tool !== 'route' || !(this.to ?? this.reachWanted)) return;
    const due = Math.max(150, this.askedAt + wait - performance.now());
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      void this.ask(false);
    }, due);
  }

  /** Asks the server; `aloud`: somebody has just asked and should hear of trouble. */
  private async ask(aloud: boolean): Promise<void> {
    this.askedAt = performance.now();
    const { robotRadius, robotHeight } = this.page.settings.get();
    const robot = { radiusM: robotRadius, heightM: robotHeight };
    const { from, to } = this;
    if (to && (from || this.fromCamera)) await this.askRoute(this.page.backend.route(from, to, robot), to);
    if (this.reachWanted) await this.page.backend.reach(from, robot).then((reach) => (this.reach = reach), (error: unknown) => this.failed(aloud, error, () => (this.reach = undefined)));
    this.show();
  }

  private async askRoute(asked: Promise<Route>, to: Point): Promise<void> {
    try {
      const route = await asked;
      if (this.to === to) Object.assign(this, { route, trouble: '' });
    } catch (error) {
      this.route = undefined;
      this.trouble = `No way: ${error instanceof Error ? error.message : String(error)}.`;
    }
  }

  private failed(aloud: boolean, error: unknown, forget: () => void): void {
    forget();
    if (aloud) void attempt(this.page, Promise.reject(error as Error));
  }
}
