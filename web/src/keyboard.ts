// Everything that a mouse can do, by keys. Kept away from text fields and other controls that use the same keys.

import { pinCell, asJson } from './panels/inspector';
import { toggleSolo } from './panels/layers';
import { togglePause } from './panels/header';
import { showHelp } from './panels/help';
import { leaveWalk, toggleWalk } from './panels/walk_hud';
import { nextFollow, showAll, toggleHold, toggleTool } from './panels/toolbar';
import type { Page } from './page';
import { STYLES } from './rules';
import { layerSetting, withLayer } from './settings';
import { turnAt } from './viewport';

const STEP_PX = 60;
const TURN = 0.12;

export interface KeyActions {
  share(): void;
  back(): boolean;
}

export function listenToKeys(page: Page, actions: KeyActions): void {
  window.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    const onControl = target.closest('input, select, textarea, button, summary, a') !== null;
    if (onControl && /^(Arrow|Enter| |Home|End|Page)/.test(event.key)) return;
    if (pressed(page, actions, event)) event.preventDefault();
  });
}

function pressed(page: Page, actions: KeyActions, event: KeyboardEvent): boolean {
  const digit = /^Digit([1-9])$/.exec(event.code)?.[1];
  if (digit) return switchLayer(page, Number(digit) - 1, event.shiftKey);
  return moves(page, event.key) || chooses(page, actions, event.key);
}

function moves({ view, ...rest }: Page, key: string): boolean {
  const { viewport } = view;
  const middle = { x: viewport.width / 2, y: viewport.height / 2 };
  switch (key) {
    case 'ArrowLeft': view.panBy(STEP_PX, 0); return true;
    case 'ArrowRight': view.panBy(-STEP_PX, 0); return true;
    case 'ArrowUp': view.panBy(0, STEP_PX); return true;
    case 'ArrowDown': view.panBy(0, -STEP_PX); return true;
    case '+': case '=': view.zoomBy(1.3); return true;
    case '-': case '_': view.zoomBy(1 / 1.3); return true;
    case 'q': view.moveTo(turnAt(viewport, TURN, middle)); return true;
    case 'e': view.moveTo(turnAt(viewport, -TURN, middle)); return true;
    case 'n': view.glideTo({ ...viewport, turn: 0 }); return true;
    case '0': showAll({ view, ...rest }); return true;
    default: return false;
  }
}

function chooses(page: Page, actions: KeyActions, key: string): boolean {
  const { settings, focus } = page;
  const now = settings.get();
  switch (key.toLowerCase()) {
    case 'f': nextFollow(page); return true;
    case 'v': settings.set({ solid: !now.solid }); return true;
    case 's': settings.set({ style: STYLES[(STYLES.indexOf(now.style) + 1) % STYLES.length] ?? 'visual' }); return true;
    case 'g': settings.set({ showGrid: !now.showGrid }); return true;
    case 'h': toggleHold(page); return true;
    case 'm': toggleTool(page, 'measure'); return true;
    case 'r': toggleTool(page, 'route'); return true;
    case 't': toggleTool(page, 'level'); return true;
    case 'w': toggleWalk(page); return true;
    case 'p': pinCell(page); return true;
    case 'c': void navigator.clipboard.writeText(asJson(page)); return true;
    case 'l': actions.share(); return true;
    case '[': settings.set({ leftPanel: !now.leftPanel }); return true;
    case ']': settings.set({ rightPanel: !now.rightPanel }); return true;
    case ' ': void togglePause(page); return true;
    case '?': showHelp(); return true;
    case 'backspace': return actions.back();
    case 'escape':
      if (focus.get().walking) leaveWalk(page);
      focus.set({ tool: 'inspect', cell: undefined, sheet: 'none', floor: undefined });
      return true;
    default: return false;
  }
}

function switchLayer({ live, settings, ...rest }: Page, index: number, alone: boolean): boolean {
  const layer = live.info?.layers[index];
  if (!layer) return false;
  if (alone) toggleSolo({ live, settings, ...rest }, layer.id);
  else settings.set(withLayer(settings.get(), layer.id, { visible: !layerSetting(settings.get(), layer.id).visible }));
  return true;
}
