'use strict';
// A report holds its data; a page without any is live.

window.addEventListener('DOMContentLoaded', async () => {
  const state = document.getElementById('state');
  try {
    const text = document.getElementById('data').textContent;
    window.page = text ? new Report(await readReport(text)) : new Live();
    window.page.start();
    requestAnimationFrame(() => requestAnimationFrame(() => {
      document.body.dataset.took = (performance.now() / 1000).toFixed(2);
      document.body.dataset.ready = 'yes';
    }));
  } catch (error) {
    state.textContent = `This page cannot be shown: ${error.message}`;
    state.className = 'bad';
    throw error;
  }
});
