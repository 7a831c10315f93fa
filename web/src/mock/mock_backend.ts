// Steering for the simulated room.

import { Refusal, type Backend } from '../backend';
import type { MockServer } from './mock_server';

export function mockBackend(server: MockServer): Backend {
  const no = (what: string) => (): Promise<never> => Promise.reject(new Refusal(`${what} needs a real server; this room is simulated in the page`));
  return {
    pause: () => Promise.resolve(server.order('pause')),
    resume: () => Promise.resolve(server.order('resume')),
    reset: () => Promise.resolve(server.order('reset')),
    changePlayback: no('Replay'),
    step: no('Replay'),
    level: no('Levelling'),
    setLevel: no('Levelling'),
    route: no('A route'),
    reach: no('Where a robot can get to'),
    views: no('A walkthrough'),
    viewMesh: no('A walkthrough'),
    exportUrl: () => undefined,
    cellUrl: () => undefined,
  };
}
