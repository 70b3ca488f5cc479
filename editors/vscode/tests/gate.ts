/** Holds up asynchronous work until the test lets it go on. */
export class Gate {
  private waiting: (() => void)[] = [];

  pass(): Promise<void> {
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  /** Lets pass whoever waits now. */
  open(): void {
    const waiting = this.waiting;
    this.waiting = [];
    for (const resolve of waiting) resolve();
  }
}

/** All promises that can settle by themselves have settled. */
export const settled = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));
