/** Does one thing at a time and, when it is done, only the newest of what came meanwhile. */
export class Latest<T> {
  private waiting: { item: T } | null = null;
  private running = false;

  /** `work` must not reject: there is no one left to tell. */
  constructor(private readonly work: (item: T) => Promise<void>) {}

  put(item: T): void {
    this.waiting = { item };
    if (!this.running) void this.run();
  }

  /** Forgets what waits; what runs goes on. */
  clear(): void {
    this.waiting = null;
  }

  private async run(): Promise<void> {
    this.running = true;
    try {
      for (let next = this.waiting; next !== null; next = this.waiting) {
        this.waiting = null;
        await this.work(next.item);
      }
    } finally {
      this.running = false;
    }
  }
}
