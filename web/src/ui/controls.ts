// The few controls that every panel is made of. Native inputs underneath: keyboard and screen reader come with them.

import { h, setText } from './dom';
import { icon, type IconName } from './icons';

export interface Control<T> {
  readonly element: HTMLElement;
  show(value: T): void;
}

let names = 0;

/** One of a few, side by side. */
export function segmented<T extends string>(label: string, choices: readonly (readonly [T, string, string?])[], choose: (value: T) => void): Control<T> {
  const name = `choice-${++names}`;
  const inputs = choices.map(([value]) => h('input', { type: 'radio', name, value, onchange: () => choose(value) }));
  const element = h('div', { class: 'segmented', role: 'radiogroup', 'aria-label': label },
    ...choices.map(([, text, title], i) => h('label', { title }, inputs[i], h('span', {}, text))));
  return { element, show: (value) => inputs.forEach((input, i) => (input.checked = choices[i]?.[0] === value)) };
}

/** A switch with its words on the left. */
export function toggle(label: string, change: (on: boolean) => void, hint?: string): Control<boolean> {
  const input = h('input', { type: 'checkbox', role: 'switch', onchange: () => change(input.checked) });
  const element = h('label', { class: 'toggle', title: hint }, h('span', {}, label), input, h('span', { class: 'knob', 'aria-hidden': 'true' }));
  return { element, show: (value) => (input.checked = value) };
}

/** A slider with label and value above it. */
export function slider(
  label: string, range: { min: number; max: number; step: number }, format: (value: number) => string, change: (value: number) => void,
): Control<number> {
  const output = h('output', {});
  const input = h('input', { type: 'range', ...range, 'aria-label': label, oninput: () => change(Number(input.value)) });
  const element = h('label', { class: 'slider' }, h('span', { class: 'slider-head' }, h('span', {}, label), output), input);
  const show = (value: number): void => {
    input.value = String(value);
    input.style.setProperty('--filled', `${(100 * (value - range.min)) / (range.max - range.min)}%`);
    setText(output, format(value));
    input.setAttribute('aria-valuetext', format(value));
  };
  return { element, show };
}

export function select<T extends string>(label: string, choices: readonly (readonly [T, string])[], choose: (value: T) => void): Control<T> {
  const input = h('select', { 'aria-label': label, onchange: () => choose(input.value as T) }, ...choices.map(([value, text]) => h('option', { value }, text)));
  const element = h('label', { class: 'select' }, h('span', {}, label), h('span', { class: 'select-box' }, input, icon('chevron')));
  return { element, show: (value) => (input.value = value) };
}

/** A square button with a picture; `label` is its name and tooltip. */
export function iconButton(name: IconName, label: string, press: (event: Event) => void, shortcut?: string): HTMLButtonElement {
  return h('button', { type: 'button', class: 'icon-button', 'aria-label': label, title: shortcut ? `${label}  (${shortcut})` : label, onclick: press }, icon(name));
}

export function setIcon(button: HTMLButtonElement, name: IconName, label: string): void {
  button.replaceChildren(icon(name));
  button.setAttribute('aria-label', label);
  button.title = label;
}

export function button(text: string, press: () => void, kind: 'plain' | 'primary' | 'danger' = 'plain'): HTMLButtonElement {
  return h('button', { type: 'button', class: `button ${kind}`, onclick: press }, text);
}

/** A titled part of a panel that can be folded. */
export function section(title: string, tab: string, ...children: (Node | false)[]): HTMLDetailsElement {
  return h('details', { class: 'section', open: true, 'data-tab': tab }, h('summary', {}, h('span', {}, title), icon('chevron')), h('div', { class: 'section-body' }, ...children));
}

/** Asks before something that cannot be undone. */
export function confirm(title: string, text: string, action: string): Promise<boolean> {
  return new Promise((resolve) => {
    const dialog = h('dialog', { class: 'dialog', 'aria-label': title });
    const answer = (yes: boolean): void => {
      dialog.close();
      dialog.remove();
      resolve(yes);
    };
    dialog.append(h('h2', {}, title), h('p', {}, text), h('div', { class: 'dialog-buttons' }, button('Cancel', () => answer(false)), button(action, () => answer(true), 'danger')));
    dialog.addEventListener('cancel', () => answer(false));
    document.body.append(dialog);
    dialog.showModal();
  });
}
