// Where everything stands on the page.

import { appearancePanel } from './panels/appearance';
import { chartsPanel } from './panels/charts';
import { staleBanner } from './panels/connection_chip';
import { header } from './panels/header';
import { showHelp } from './panels/help';
import { inspectorPanel } from './panels/inspector';
import { layersPanel } from './panels/layers';
import { legend } from './panels/legend';
import { mapCorner } from './panels/map_corner';
import { emptyState, notices } from './panels/notices';
import { overlay, type Overlay } from './panels/overlay';
import { picturesPanel } from './panels/pictures';
import { statusPanel } from './panels/status';
import { tabs } from './panels/tabs';
import { timeline } from './panels/timeline';
import { toolbar } from './panels/toolbar';
import { walkHud } from './panels/walk_hud';
import type { Page } from './page';
import { h } from './ui/dom';

/** Builds the page around `map`; returns the part that draws over the map. */
export function layout(page: Page, map: HTMLElement, share: () => void): Overlay {
  const over = overlay(page);
  map.classList.add('map');
  page.view.canvas.setAttribute('aria-label', 'Map. Arrow keys move it, plus and minus zoom.');
  page.view.canvas.setAttribute('role', 'application');
  map.append(over.element, emptyState(page), legend(page), mapCorner(page), walkHud(page), toolbar(page), timeline(page), staleBanner(page), notices(page));
  const left = h('aside', { class: 'side left', 'aria-label': 'Map and layers' }, layersPanel(page), appearancePanel(page));
  const right = h('aside', { class: 'side right', 'aria-label': 'Camera, cell and status' }, picturesPanel(page), inspectorPanel(page), statusPanel(page, chartsPanel(page)));
  document.body.append(header(page, { share, help: showHelp }), left, map, right, tabs(page));
  page.settings.watch(['leftPanel', 'rightPanel'], ({ leftPanel, rightPanel }) => {
    document.body.classList.toggle('no-left', !leftPanel);
    document.body.classList.toggle('no-right', !rightPanel);
  });
  return over;
}
