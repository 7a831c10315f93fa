// Our own line icons on a 16 x 16 grid, drawn in the colour of the text around them.

import { svg } from './dom';

const PATHS = {
  layers: 'M8 2 14 5 8 8 2 5Z M2 8l6 3 6-3 M2 11l6 3 6-3',
  eye: 'M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8Z M8 6a2 2 0 1 0 0 4 2 2 0 0 0 0-4Z',
  eyeOff: 'M2 2l12 12 M6 4a6 6 0 0 1 2-.5c4 0 6.500 4.500 6.500 4.500a11 11 0 0 1-2 2.500 M4.200 5.300A11 11 0 0 0 1.500 8S4 12.500 8 12.500a6 6 0 0 0 2.600-.6',
  solo: 'M8 2v2 M8 12v2 M2 8h2 M12 8h2 M8 5.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5Z',
  plus: 'M8 3v10 M3 8h10',
  minus: 'M3 8h10',
  fit: 'M2 5.500V2h3.500 M10.500 2H14v3.500 M14 10.500V14h-3.500 M5.500 14H2v-3.500',
  follow: 'M8 1.500 12.500 14 8 11 3.500 14Z',
  compass: 'M8 1.500a6.500 6.500 0 1 0 0 13 6.500 6.500 0 0 0 0-13Z M8 4l1.800 4L8 12 6.200 8Z',
  cube: 'M8 1.500 13.500 4.500v7L8 14.500 2.500 11.500v-7Z M2.500 4.500 8 7.500l5.500-3 M8 7.500v7',
  ruler: 'M2 10.500 10.500 2 14 5.500 5.500 14Z M5 7.500l1.500 1.500 M7.500 5l2 2',
  route: 'M4 13.500a1.500 1.500 0 1 0 0-3 1.500 1.500 0 0 0 0 3Z M12 5.500a1.500 1.500 0 1 0 0-3 1.500 1.500 0 0 0 0 3Z M5.500 12H10a2 2 0 0 0 0-4H6a2 2 0 0 1 0-4h4.500',
  level: 'M2 13.500h12 M3 10 13 6 M5.800 12.200a1.200 1.200 0 1 0 2.400 0 M8 2.500v3',
  pause: 'M5.500 3v10 M10.500 3v10',
  play: 'M4.500 2.800v10.400L13 8Z',
  step: 'M3.500 3v10L10 8Z M12.500 3v10',
  reset: 'M3 8a5 5 0 1 0 1.500-3.500L2.500 6.300 M2.500 2.500v3.800h3.800',
  download: 'M8 2v8 M4.500 7 8 10.500 11.500 7 M2.500 13.500h11',
  link: 'M6.500 9.500l3-3 M7.500 4.500 9 3a2.800 2.800 0 0 1 4 4l-1.500 1.500 M8.500 11.500 7 13a2.800 2.800 0 0 1-4-4l1.500-1.500',
  sun: 'M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6Z M8 1.500v1 M8 13.500v1 M1.500 8h1 M13.500 8h1 M3.400 3.400l.7.7 M11.900 11.900l.7.7 M3.400 12.600l.7-.7 M11.900 4.100l.7-.7',
  moon: 'M13.500 9.500A6 6 0 0 1 6.500 2.500a6 6 0 1 0 7 7Z',
  auto: 'M8 2a6 6 0 1 0 0 12A6 6 0 0 0 8 2Z M8 2v12 M8 5h4.500 M8 8h6 M8 11h4.500',
  help: 'M8 1.800a6.200 6.200 0 1 0 0 12.400A6.200 6.200 0 0 0 8 1.800Z M6.200 6.200a1.900 1.900 0 1 1 2.700 1.700c-.6.3-.9.7-.9 1.300 M8 11.300v.2',
  close: 'M3.500 3.500l9 9 M12.500 3.500l-9 9',
  camera: 'M2 4.500h3l1-1.500h4l1 1.500h3v8.500H2Z M8 6.300a2.300 2.300 0 1 0 0 4.600 2.300 2.300 0 0 0 0-4.600Z',
  target: 'M8 1.500v3 M8 11.500v3 M1.500 8h3 M11.500 8h3 M8 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8Z',
  person: 'M8 1.500a1.700 1.700 0 1 0 0 3.400 1.700 1.700 0 0 0 0-3.400Z M8 6.500v4 M8 10.500 5.500 14.500 M8 10.500l2.500 4 M4.500 9 8 7l3.500 2',
  pulse: 'M1.500 8.500h3l2-5 3 9 2-4h3',
  sliders: 'M2 4.500h7 M12 4.500h2 M10.500 3v3 M2 11.500h2 M7 11.500h7 M5.500 10v3',
  pin: 'M8 14.500V10 M5 2.500h6 M5.500 2.500 5 7 3.500 10h9L11 7l-.5-4.500',
  copy: 'M5.500 5.500h8v8h-8Z M3 10.500h-.5v-8h8V3',
  warning: 'M8 2 14.500 13.500h-13Z M8 6.500v3.500 M8 11.800v.2',
  left: 'M10 3 5 8l5 5',
  right: 'M6 3l5 5-5 5',
  chevron: 'M4 6l4 4 4-4',
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGElement {
  const element = svg('svg', { viewBox: '0 0 16 16', width: 16, height: 16, 'aria-hidden': 'true', class: 'icon' });
  element.append(svg('path', { d: PATHS[name] }));
  return element;
}

/** The project's mark: three layers, seen from the side. */
export function mark(): SVGElement {
  return svg(
    'svg', { viewBox: '0 0 24 24', width: 22, height: 22, 'aria-hidden': 'true', class: 'mark' },
    svg('path', { d: 'M12 12.500 21.500 17 12 21.500 2.500 17Z', class: 'mark-low' }),
    svg('path', { d: 'M12 7.500 21.500 12 12 16.500 2.500 12Z', class: 'mark-middle' }),
    svg('path', { d: 'M12 2.500 21.500 7 12 11.500 2.500 7Z', class: 'mark-high' }),
  );
}
